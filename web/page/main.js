// The start of the page: its buttons, its keys, and what happens once per frame of the screen.

import { App } from "./app.js";
import { manifestOf } from "./downloads.js";
import { acceptFiles } from "./drop.js";
import { $, isPressed, makeButton, makeToolbar, pressed } from "./elements.js";
import { HardwarePanel } from "./hardware_panel.js";
import { memBytes } from "./memory.js";
import { frame } from "./navigation.js";
import { dismiss, notice } from "./notices.js";
import { makePilot } from "./pilot.js";
import { save } from "./save.js";
import { sourceOfAddress, sourceOfExample, sourceOfFiles } from "./sources.js";
import { makeTools } from "./tools.js";
/** @import { Site } from "./app.js" */

const CLICK = 5; // pixels that a click may move

/** The address, and the choices for one file, no longer belong to what is shown. @param {App} app */
function forgetSource(app) {
  history.replaceState(null, "", location.pathname);
  app.panel.choices.options = { ...app.panel.choices.options, up: null, unit: null };
}

/** Opens what was chosen last: a choice ends the loading of the one before. */
class Opening {
  #current = new AbortController();

  /** Reports an error as a notice of that title. @param {string} title @param {(signal: AbortSignal) => Promise<void>}
   * open */
  async start(title, open) {
    this.cancel();
    const { signal } = this.#current;
    try {
      await open(signal);
    } catch (error) {
      if (!signal.aborted) notice("error", title, /** @type {Error} */ (error).message);
    }
  }

  cancel() {
    this.#current.abort();
    this.#current = new AbortController();
  }
}

/** @param {App} app @param {Site} site @param {Opening} opening */ function openScenes(app, site, opening) {
  acceptFiles((files) => {
    if (!files.length) return;
    opening.start("The files cannot be read", async (signal) => {
      const source = await sourceOfFiles(files);
      signal.throwIfAborted();
      forgetSource(app);
      await app.open(source);
    });
  });
  $("open").onclick = () => $("files").click();
  for (const [name, { title }] of Object.entries(site.examples)) {
    const open = async (/** @type {AbortSignal} */ signal) => {
      const source = await sourceOfExample(name, site, signal);
      forgetSource(app);
      await app.open(source);
    };
    const chip = makeButton($("examples"), title, () => opening.start("The example cannot be loaded", open));
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
  $("save-mem").onclick = async () => {
    const memory = await app.settled();
    if (memory) save(new Blob([memBytes(memory.words)], { type: "text/plain" }), `${memory.name}.mem`);
  };
  $("save-manifest").onclick = async () => {
    const memory = await app.settled();
    if (!memory) return;
    const text = `${JSON.stringify(manifestOf(memory), null, 2)}\n`;
    save(new Blob([text], { type: "application/json" }), `${memory.name}.json`);
  };
  const fail = (/** @type {Error} */ { message }) => {
    if (message !== "cancelled") notice("error", "This cannot be saved", message); // another memory came
  };
  $("save").onclick = () => import("./stills.js").then(({ savePicture }) => savePicture(app)).catch(fail);
  $("turntable").onclick = async () => {
    $("turntable").disabled = true;
    await import("./turntable.js").then(({ record }) => record(app)).catch(fail);
    $("turntable").disabled = false;
  };
}

/** Keys, gestures and buttons move the camera. Editing and walking are loaded when they are wanted. @param {App}
 * app */
function steer(app) {
  const canvas = $("picture");
  const commands = {
    ...makeTools(),
    KeyF: () => app.glide((now) => frame(now, app.bounds(), app.size(), app.limit())),
    KeyB: () => $("edit-toggle").click(),
    KeyR: () => app.glide(() => app.firstView()),
    KeyI: () => {
      const { x, y, width, height } = canvas.getBoundingClientRect();
      app.followAt(x + width / 2, y + height / 2);
    },
    ...app.views.commands(),
  };
  $("frame").onclick = commands.KeyF;
  const { gestures, flight } = makePilot(app, canvas, commands, (x, y) => {
    if (!isPressed($("inspect")) && !isPressed($("walk")) && !document.body.classList.contains("editing"))
      app.focusAt(x, y);
  });
  const load = once(async () => {
    const { EditMode } = await import("./edit_mode.js");
    return new EditMode(app, gestures, flight, commands);
  });
  const fail = (/** @type {Error} */ { message }) => notice("error", "The scene cannot be edited", message);
  $("edit-toggle").onclick = () => load().then((edit) => edit.toggle(), fail);
  $("walk").onclick = () => load().then((edit) => edit.walker.start(), fail);
  return { gestures, flight };
}

/** A promise that is made with the first call. @template T @param {() => Promise<T>} make */ function once(make) {
  /** @type {Promise<T> | null} */ let made = null;
  return () => {
    made ??= make();
    return made;
  };
}

async function compile() {
  const url = "voxrt/voxrt.wasm";
  return WebAssembly.compileStreaming(fetch(url)).catch(async () =>
    WebAssembly.compile(await (await fetch(url)).arrayBuffer()),
  );
}

/** Show what the address names. @param {App} app @param {Site} site @param {Opening} opening */
function openAddress(app, site, opening) {
  addEventListener("hashchange", () => location.reload()); // another link in the same tab
  opening.start("This link cannot be shown", async (signal) => {
    signal.addEventListener("abort", dismiss);
    const cancel = () => opening.cancel();
    const onStage = (/** @type {string} */ text) => notice("progress", "Loading", text, { cancel });
    const { source, camera, ...options } = await sourceOfAddress(location, site, onStage, signal);
    signal.throwIfAborted();
    signal.removeEventListener("abort", dismiss);
    dismiss();
    app.panel.set(options);
    await app.open(source);
    if (camera && app.source === source) app.viewpoint.change((now) => ({ ...now, ...camera }));
  });
}

async function start() {
  /** @type {[WebAssembly.Module, Site]} */
  const [module, site] = await Promise.all([compile(), fetch("site.json").then((answer) => answer.json())]);
  const app = new App(module, site);
  new HardwarePanel(app, module);
  const opening = new Opening();
  openScenes(app, site, opening);
  inspect(app);
  offerDownloads(app);
  const pilot = steer(app);
  openAddress(app, site, opening);
  const animate = () => {
    requestAnimationFrame(animate);
    app.viewpoint.step(pilot);
  };
  animate();
  setInterval(() => app.figures.show(), 250);
  navigator.serviceWorker?.register("offline.js").catch(() => {}); // without it the page needs the network
}
start().catch((error) => notice("error", "The page cannot start", error.message));
