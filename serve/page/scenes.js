// The scenes: those of the server, and files that are opened or dropped. Loading shows its progress and can be cancelled.

import { $, makeButton, makeToolbar, pressed } from "./elements.js";
import { dismiss, notice } from "./notices.js";
import { uploadFiles } from "./upload.js";

const STAGES = {
  send: "Sending",
  read: "Reading",
  write: "Writing to the device",
  verify: "Verifying",
  render: "Rendering the first frame",
  load: "Loading the file",
  fit: "Fitting the grid",
  colour: "Choosing colours",
  voxelize: "Voxelizing",
  octree: "Building the octree",
};
const ALSO = [".json", ".bin", ".mtl", ".png", ".jpg", ".jpeg"]; // what scene files refer to

// `app` is that of main.js.
export class Scenes {
  constructor(app) {
    this.app = app;
    for (const bar of document.querySelectorAll("[data-scenes]")) makeToolbar(bar);
    for (const button of document.querySelectorAll("[data-open]")) button.onclick = () => $("files").click();
    $("files").onchange = ({ target }) => {
      this.open([...target.files]);
      target.value = "";
    };
    let drags = 0;
    addEventListener("dragenter", (event) => {
      event.preventDefault();
      drags += 1;
      $("drop").hidden = false;
    });
    addEventListener("dragleave", () => {
      drags -= 1;
      $("drop").hidden = drags <= 0;
    });
    addEventListener("dragover", (event) => event.preventDefault());
    addEventListener("drop", (event) => {
      event.preventDefault();
      drags = 0;
      $("drop").hidden = true;
      this.open([...event.dataTransfer.files]);
    });
  }

  hello({ scenes, suffixes }) {
    for (const text of document.querySelectorAll("[data-formats]")) text.textContent = `Opens ${suffixes.join(" ")}`;
    $("files").accept = [...suffixes, ...ALSO].join(",");
    $("examples").hidden = scenes.length === 0;
    for (const bar of document.querySelectorAll("[data-scenes]")) {
      bar.replaceChildren();
      for (const name of scenes) makeButton(bar, name, () => this.show(name)).dataset.scene = name;
    }
  }

  mark({ scene }) {
    for (const made of document.querySelectorAll("[data-scene]")) pressed(made, made.dataset.scene === scene.name);
    $("empty").hidden = scene.number !== 0;
    $("stage").classList.toggle("empty", scene.number === 0);
  }

  show(name) {
    this.load(name, (report, signal) =>
      this.app.connection.request("show", { scene: name }, ({ stage, done, total }) => report(stage, done, total)),
    );
  }

  open(files) {
    if (files.length)
      this.load(files[0].name, (report, signal) => uploadFiles(this.app.connection, files, report, signal));
  }

  // Run what loads another scene.
  async load(name, run) {
    if (!this.app.hasControl())
      return notice("error", "You do not have control", "Take control before you change the scene.");
    const aborter = new AbortController();
    const cancel = () => {
      aborter.abort();
      this.app.connection.request("cancel").catch(() => {});
    };
    notice("progress", `${name} …`, "", { progress: 0, cancel });
    this.app.coarsen();
    try {
      await run((stage, done, total) => {
        if (!aborter.signal.aborted)
          notice("progress", `${name} …`, STAGES[stage] ?? stage, { progress: total ? done / total : 0, cancel });
      }, aborter.signal);
      dismiss();
    } catch (error) {
      if (aborter.signal.aborted) dismiss();
      else notice("error", `${name} was not loaded`, `${error.message.replace(/\.$/, "")}. The scene has not changed.`);
    }
  }
}
