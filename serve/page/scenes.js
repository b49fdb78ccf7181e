// The scenes: those of the server, and files that are opened or dropped. Loading shows its progress and can be cancelled.

import { acceptFiles } from "./drop.js";
import { $, all, element, makeButton, makeToolbar, pressed } from "./elements.js";
import { dismiss, notice } from "./notices.js";
import { uploadFiles } from "./upload.js";

/** @type {Record<string, string>} */ const STAGES = {
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

/** @import { App } from "./app.js" @import { Hello, State } from "./protocol.js" */

/** @typedef {(stage: string, done: number, total: number) => void} OnProgress */

export class Scenes {
  /** @type {Map<string, File[]>} files of this viewer that were shown, by the scene's name */ #opened = new Map();

  /** @param {App} app */ constructor(app) {
    this.app = app;
    for (const bar of all("[data-scenes]")) makeToolbar(bar);
    for (const button of all("[data-open]")) button.onclick = () => $("files").click();
    acceptFiles((files) => this.open(files));
  }

  /** @param {Hello} hello */ hello({ scenes, suffixes }) {
    for (const text of all("[data-formats]")) text.textContent = `Opens ${suffixes.join(" ")}`;
    $("files").accept = [...suffixes, ...ALSO].join(",");
    $("examples").hidden = scenes.length === 0;
    for (const bar of all("[data-scenes]")) {
      bar.replaceChildren();
      for (const name of scenes) makeButton(bar, name, () => this.request(name)).dataset.scene = name;
      for (const [name, files] of this.#opened)
        if (!scenes.includes(name)) makeButton(bar, name, () => this.open(files)).dataset.scene = name;
    }
  }

  /** @param {State} state */ show({ scene }) {
    for (const made of all("[data-scene]")) pressed(made, made.dataset.scene === scene.name);
    $("empty").hidden = scene.number !== 0;
    $("stage").classList.toggle("empty", scene.number === 0);
    $("warnings").replaceChildren(...(scene.warnings ?? []).map((text) => element("li", {}, text)));
  }

  /** Show a scene of the server. @param {string} name */ request(name) {
    this.load(name, (report) =>
      this.app.connection.request("show", { scene: name }, ({ stage, done, total }) => report(stage, done, total)),
    );
  }

  /** @param {File[]} files */ open(files) {
    if (!files.length) return;
    this.load(files[0].name, async (report, signal) => {
      const { name } = await uploadFiles(this.app.connection, files, report, signal);
      this.#opened.set(name, files);
      if (this.app.connection.hello) this.hello(this.app.connection.hello);
      this.show(this.app.state());
    });
  }

  /** Run what loads another scene. @param {string} name @param {(report: OnProgress, signal: AbortSignal) =>
   * Promise<unknown>} run */
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
      const { message } = /** @type {Error} */ (error);
      if (aborter.signal.aborted) dismiss();
      else notice("error", `${name} was not loaded`, `${message.replace(/\.$/, "")}. The scene has not changed.`);
    }
  }
}
