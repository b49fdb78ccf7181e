// The start of the page: its buttons, its keys, and what happens once per frame of the screen.

import { App } from "./app.js";
import { linkOf, manifestOf, readLink } from "./downloads.js";
import { acceptFiles } from "./drop.js";
import { $, isPressed, makeButton, makeToolbar, pressed } from "./elements.js";
import { HardwarePanel } from "./hardware_panel.js";
import { memBytes } from "./memory.js";
import { frame } from "./navigation.js";
import { notice } from "./notices.js";
import { makePilot } from "./pilot.js";
import { save } from "./save.js";
import { sourceOfExample, sourceOfFiles } from "./sources.js";
import { makeTools } from "./tools.js";
/** @import { Site } from "./app.js" */

const CLICK = 5; // pixels that a click may move

/** @param {App} app @param {Site} site */ function openScenes(app, site) {
  acceptFiles(async (files) => {
    if (!files.length) return;
    history.replaceState(null, "", location.pathname + location.search);
    await app.open(await sourceOfFiles(files));
  });
  $("open").onclick = () => $("files").click();
  for (const [name, { title }] of Object.entries(site.examples)) {
    const open = async () => app.open(await sourceOfExample(name, site));
    const fail = (/** @type {Error} */ { message }) => notice("error", "The example cannot be loaded", message);
    const chip = makeButton($("examples"), title, () => open().catch(fail));
    chip.dataset.example = name;
    pressed(chip, false);
  }
  makeToolbar($("examples"));
}

/** A click follows a ray while "inspect" is pressed. @param {App} app */
function inspect(app) {
  const canvas = $("picture");
  let place = [0, 0]; // where the pointer was pressed
  canvas.addEventListener("pointerdown", ({ clientX, clientY }) => {
    place = [clientX, clientY];
  });
  canvas.addEventListener("click", ({ clientX, clientY }) => {
    const isStill = Math.hypot(clientX - place[0], clientY - place[1]) <= CLICK;
    if (isPressed($("inspect")) && isStill) app.followAt(clientX, clientY);
  });
  $("inspect").onclick = () => {
    const on = !isPressed($("inspect"));
    pressed($("inspect"), on);
    document.body.classList.toggle("inspecting", on);
    if (!on) app.inspector.clear();
  };
}

/** @param {App} app */ function offerDownloads(app) {
  $("save-mem").onclick = () => {
    const memory = app.memory();
    if (memory) save(new Blob([memBytes(memory.words)], { type: "text/plain" }), `${memory.name}.mem`);
  };
  $("save-manifest").onclick = () => {
    const memory = app.memory();
    if (!memory) return;
    const text = `${JSON.stringify(manifestOf(memory), null, 2)}\n`;
    save(new Blob([text], { type: "application/json" }), `${memory.name}.json`);
  };
  $("save").onclick = () => {
    const memory = app.memory();
    if (memory) app.picture.save(memory.name);
  };
  $("copy").onclick = async () => {
    const [memory, view] = [app.memory(), app.view()];
    if (!memory || !view) return;
    const { bake, budget } = app.panel.options();
    const example = app.source?.example ?? null;
    history.replaceState(null, "", linkOf({ example, depth: memory.depth, bake, words: budget, view }));
    const copied = navigator.clipboard?.writeText(location.href);
    const done = await copied?.then(() => true).catch(() => false);
    $("copy").textContent = done ? "Copied" : "In the address bar";
    setTimeout(() => {
      $("copy").textContent = "Copy link";
    }, 1500);
  };
}

/** Keys, gestures and buttons move the camera. @param {App} app */
function steer(app) {
  const canvas = $("picture");
  const commands = {
    ...makeTools(),
    KeyF: () => app.glide((now) => frame(now, app.bounds(), app.size(), app.limit())),
    KeyR: () => app.glide(() => app.firstView()),
    KeyI: () => {
      const { x, y, width, height } = canvas.getBoundingClientRect();
      app.followAt(x + width / 2, y + height / 2);
    },
    ...app.views.commands(),
  };
  $("frame").onclick = commands.KeyF;
  return makePilot(app, canvas, commands, (x, y) => {
    if (!isPressed($("inspect"))) app.focusAt(x, y);
  });
}

async function compile() {
  const url = "voxrt/voxrt.wasm";
  return WebAssembly.compileStreaming(fetch(url)).catch(async () =>
    WebAssembly.compile(await (await fetch(url)).arrayBuffer()),
  );
}

async function start() {
  /** @type {[WebAssembly.Module, Site]} */
  const [module, site] = await Promise.all([compile(), fetch("site.json").then((answer) => answer.json())]);
  const app = new App(module, site);
  new HardwarePanel(app, module);
  openScenes(app, site);
  inspect(app);
  offerDownloads(app);
  const pilot = steer(app);
  const { example, camera, ...options } = readLink(location.hash);
  app.panel.set(options);
  await app.open(await sourceOfExample(example && example in site.examples ? example : "courtyard", site));
  if (camera) app.viewpoint.change((now) => ({ ...now, ...camera }));
  const animate = () => {
    requestAnimationFrame(animate);
    app.viewpoint.step(pilot);
  };
  animate();
  setInterval(() => app.figures.show(), 250);
}
start().catch((error) => notice("error", "The page cannot start", error.message));
