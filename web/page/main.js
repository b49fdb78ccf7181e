// The static page: dropped files and examples become a memory in one worker, and pictures of it in several. The camera and
// its controls are those of the server's page.

import { BandPicture, coloursOf } from "./band_picture.js";
import { BoardPanel } from "./board_panel.js";
import { Budget } from "./budget.js";
import { Builder } from "./builder.js";
import { FIELD_OF_VIEW, fromRegisters, lookAlong, pixelDirection, pose, toRegisters } from "./camera.js";
import { DaylightControl } from "./daylight.js";
import { linkOf, manifestOf, readLink, save } from "./downloads.js";
import { $, isPressed, makeButton, makeToolbar, pressed } from "./elements.js";
import { Figures } from "./figures.js";
import { FrameRequests } from "./frame_requests.js";
import { Glide } from "./glide.js";
import { HardwarePanel } from "./hardware_panel.js";
import { Inspector } from "./inspector.js";
import { Light } from "./light.js";
import { memBytes } from "./mem.js";
import { focus, frame } from "./navigation.js";
import { dismiss, notice } from "./notices.js";
import { Painter } from "./painter.js";
import { makePilot } from "./pilot.js";
import { Views } from "./views.js";
import { BACKGROUND, FACES } from "./voxrt/voxrt.js";

const CORNER = [-0.62, -0.55, -1];
const CLICK = 5; // pixels that a click may move
const LAMP = [1.4, 1.9, 1.1]; // sides of the world

const canvas = $("picture");
const picture = new BandPicture(canvas);
const figures = new Figures($("figures"));
const glide = new Glide();
let painter, builder, frames, light, inspector, daylight, budget, boardPanel;
let view = null; // the camera for people of camera.js
let memory = null; // what worker.js built, with voxels and bounds
let source = null; // {files, example}
const bright = matchMedia("(prefers-color-scheme: light)").matches;
const PLAIN_LOOK = { shading: "faces", features: [], ambient: 90, bounces: 3 };
const AROUND = bright ? [228, 234, 244] : BACKGROUND;
let look = { ...PLAIN_LOOK, light: [0, 0, 0], background: AROUND };

const app = {
  view: () => view,
  memory: () => memory,
  device: () => painter.hello.device,
  state: () => ({ view: look, scene: { depth: memory?.depth ?? 1 } }),
  size: () => frames.size,
  side: () => 2 ** memory.depth,
  bounds: () => memory.bounds,
  limit: () => 8 * app.side() + 512,
  plainLook: () => ({ ...shading(), mirrors: [], light: null, bounces: 0 }),
  change(how) {
    if (!view) return;
    glide.stop();
    view = how(view);
    frames.change();
    inspector.clear();
  },
  glide(how) {
    if (!view) return;
    inspector.clear();
    glide.start(view, how(view), frames.resolution.seconds(frames.size) > 1);
  },
  set(fields) {
    look = { ...look, ...fields };
    painter.shade(shading());
    light.show(app.state());
    canvas.style.backgroundColor = `rgb(${look.background.join()})`;
    frames.change();
  },
};

// How workers colour hits: what the controls say of it.
function shading() {
  const materials = memory.materials.map((material, id) => (id ? material.colour : look.background));
  return {
    materials,
    mirrors: memory.materials.flatMap(({ mirror }, id) => (mirror ? [id] : [])),
    flat: look.shading === "flat",
    faces: look.shading === "faces" ? (memory.lighting?.faces ?? FACES) : null,
    light: look.features.includes("light") ? { position: look.light, ambient: look.ambient } : null,
    bounces: look.features.includes("mirrors") ? look.bounces : 0,
  };
}

// Build the memory of the current files at the depth of the slider, and show it.
async function build(first) {
  const depth = Number($("depth").value);
  const wanted = source;
  const show = (stage) =>
    notice("progress", stage, source.files[0].name, {
      cancel: () => {
        builder.cancel();
        dismiss();
      },
    });
  const timer = setTimeout(() => show("Building"), 250);
  let stage = "";
  try {
    const built = await builder.build(
      source.files,
      { depth, fill: "auto", bake: daylight.options, budget: budget.words },
      (now) => {
        stage = now;
        if (!$("notice").hidden) show(now);
      },
    );
    if (source !== wanted) return;
    clearTimeout(timer);
    await showMemory(built, first);
    dismiss();
  } catch (error) {
    clearTimeout(timer);
    if (error.message === "cancelled") return;
    notice(
      "error",
      stage === "Reading" || !stage ? "The model cannot be shown" : "The model cannot be voxelized",
      error.message,
    );
  }
}

async function showMemory(built, first) {
  // A memory is shown as it says. What the user chooses then stays, until a memory says something else.
  if ((first && built.lighting) || !same(built.lighting, memory?.lighting))
    look = { ...look, ...lookOf(built.lighting) };
  const [background, old] = [built, memory].map(ownBackground);
  if (background || old) look.background = background ?? AROUND;
  memory = built;
  memory.bounds = [[0, 0, 0], Array(3).fill(2 ** built.depth)];
  look.light = built.lighting?.on
    ? built.lighting.position
    : LAMP.map((part) => Math.round(part * 16 * 2 ** built.depth));
  inspector.clear();
  await painter.load(built, shading());
  const { voxels, outline } = await painter.census();
  if (memory !== built) return;
  Object.assign(memory, { voxels, bounds: boundsOf(outline) ?? memory.bounds });
  frames.discard();
  const scaled = view && !first ? rescaled(view, memory.depth - first_depth) : null;
  view = scaled ?? firstView();
  first_depth = memory.depth;
  $("stage").classList.remove("empty");
  light.show(app.state());
  canvas.style.backgroundColor = `rgb(${look.background.join()})`;
  describe();
  frames.change();
  $("stage").setAttribute("aria-busy", "true");
  $("stage").dataset.scene = `${built.name} ${built.depth}`;
}

const same = (one, other) => JSON.stringify(one ?? null) === JSON.stringify(other ?? null);

// The look of a lighting, whose fields are those of manifests.
function lookOf(lighting) {
  if (!lighting) return PLAIN_LOOK;
  const { position, ambient, on, flat, bounces, faces } = lighting;
  return {
    shading: flat ? "flat" : faces ? "faces" : "report",
    light: position,
    ambient,
    bounces: bounces || PLAIN_LOOK.bounces,
    features: [...(on ? ["light"] : []), ...(bounces ? ["mirrors"] : [])],
  };
}

// The background that a memory has of its own, or null.
const ownBackground = (built) =>
  built?.manifest && !same(built.materials[0].colour, BACKGROUND) ? built.materials[0].colour : null;

let first_depth = 7; // of the memory that `view` belongs to

const firstView = () =>
  authoredView() ??
  frame(lookAlong(pose([0, 0, 0], 0, 0, FIELD_OF_VIEW.usual, 1), CORNER), app.bounds(), app.size(), app.limit());

const MADE_FOR = [640, 480]; // the cameras of manifests

function authoredView() {
  if (!memory.view || !memory.view.look.some(Boolean)) return null;
  const [low, high] = memory.bounds;
  return fromRegisters(
    memory.view,
    MADE_FOR,
    low.map((part, axis) => (part + high[axis]) / 2),
    app.size(),
  );
}

// The same view of a world of more or fewer levels.
function rescaled(old, levels) {
  const factor = 2 ** levels;
  return { ...old, eye: old.eye.map((value) => value * factor), distance: old.distance * factor };
}

function boundsOf(cubes) {
  if (!cubes.length) return null;
  const [low, high] = [
    [Infinity, Infinity, Infinity],
    [-Infinity, -Infinity, -Infinity],
  ];
  for (let i = 0; i < cubes.length; i += 4)
    for (let axis = 0; axis < 3; axis++) {
      low[axis] = Math.min(low[axis], cubes[i + axis]);
      high[axis] = Math.max(high[axis], cubes[i + axis] + cubes[i + 3]);
    }
  return [low, high];
}

const short = new Intl.NumberFormat("en", { notation: "compact", maximumSignificantDigits: 3 });
const kib = (words) =>
  words < 262144
    ? `${(words / 256).toLocaleString("en", { maximumFractionDigits: 1 })} KiB`
    : `${(words / 262144).toLocaleString("en", { maximumFractionDigits: 1 })} MiB`;

function describe() {
  const { name, words, depth, voxels, warnings, fixed, seconds } = memory;
  const solid = voxels.reduce((sum, count, id) => (id ? sum + count : 0), 0);
  $("scene").textContent = name;
  $("details").textContent =
    `${(2 ** depth).toLocaleString("en")}³ voxels · ${words.length.toLocaleString("en")} words${seconds ? ` · ${seconds.toFixed(2)} s` : ""}`;
  document.title = `${name} · voxrt`;
  for (const control of ["depth", "bake", "budget", "budget-words"]) $(control).disabled = Boolean(fixed);
  if (fixed) $("depth").value = depth;
  showDepth();
  const facts = {
    words: words.length.toLocaleString("en"),
    memory: kib(words.length),
    "solid voxels": short.format(solid),
  };
  const { fitted } = memory;
  if (fitted)
    Object.assign(facts, {
      "without budget": fitted.wordsShared.toLocaleString("en"),
      "surface changed": `${((100 * fitted.changed) / (fitted.surface || 1)).toFixed(1)} %`,
    });
  budget.fits(fitted?.wordsShared ?? words.length);
  $("facts").replaceChildren(
    ...Object.entries(facts).map(([term, value]) => {
      const box = document.createElement("div");
      box.append(
        Object.assign(document.createElement("dt"), { textContent: term }),
        Object.assign(document.createElement("dd"), { textContent: value }),
      );
      return box;
    }),
  );
  $("boards").replaceChildren(
    ...Object.entries(boards).map(([board, limit]) => {
      const row = document.createElement("li");
      const fits = words.length <= limit;
      const meter = Object.assign(document.createElement("meter"), {
        min: 0,
        max: 1,
        high: 0.999,
        optimum: 0,
        value: Math.min(1, words.length / limit),
      });
      meter.setAttribute("aria-label", `Memory of ${board} in use`);
      const verdict = Object.assign(document.createElement("span"), {
        className: fits ? "fits" : "large",
        textContent: fits ? "fits" : `${(words.length / limit).toFixed(1)} × too large`,
      });
      row.append(Object.assign(document.createElement("span"), { textContent: board }), meter, verdict);
      if (fits && designs.includes(board)) verdict.replaceWith(boardPanel.button(board));
      else if (!fits && !fixed) verdict.replaceWith(fitButton(board, limit, verdict.textContent));
      return row;
    }),
  );
  $("warnings").replaceChildren(
    ...warnings.map(({ message, count }) =>
      Object.assign(document.createElement("li"), { textContent: count > 1 ? `${message} (${count})` : message }),
    ),
  );
  for (const chip of $("examples").children) pressed(chip, chip.dataset.example === source?.example);
}

function fitButton(board, limit, why) {
  const button = Object.assign(document.createElement("button"), {
    type: "button",
    textContent: "Fit",
    title: `${why}: give up what is seen least`,
  });
  button.setAttribute("aria-label", `Fit to ${board}`);
  button.onclick = () => budget.choose(limit);
  return button;
}

const showDepth = () => {
  $("depth-value").textContent = `${(2 ** Number($("depth").value)).toLocaleString("en")}³`;
};

async function openFiles(list) {
  const files = await Promise.all(
    [...list].map(async (file) => ({ name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) })),
  );
  if (!files.length) return;
  source = { files, example: null };
  history.replaceState(null, "", location.pathname + location.search);
  await build(true);
}

async function openExample(name) {
  const files = await Promise.all(
    examples[name].files.map(async (file) => {
      const answer = await fetch(`examples/${file}`);
      if (!answer.ok) throw new Error(`examples/${file}: ${answer.status}`);
      return { name: file, bytes: new Uint8Array(await answer.arrayBuffer()) };
    }),
  );
  source = { files, example: name };
  await build(true);
}

// Every file of a drop, those in folders too.
async function dropped(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
  if (!entries.some((entry) => entry.isDirectory)) return [...transfer.files];
  const found = [];
  const read = async (entry) => {
    if (entry.isFile) found.push(await new Promise((resolve, reject) => entry.file(resolve, reject)));
    else {
      const reader = entry.createReader();
      for (let some = [null]; some.length; ) {
        some = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
        for (const child of some) await read(child);
      }
    }
  };
  for (const entry of entries) await read(entry);
  return found;
}

async function followAt(x, y) {
  if (!memory) return;
  const size = [canvas.width, canvas.height];
  const [column, row] = picture.pixelAt(x, y);
  if (column < 0 || row < 0 || column >= size[0] || row >= size[1]) return;
  const registers = toRegisters(view, size);
  try {
    const followed = await painter.follow(registers.position, pixelDirection(registers, size, column, row));
    inspector.show(followed, registers, size, [column, row]);
  } catch (error) {
    notice("error", "The ray cannot be followed", error.message);
  }
}

async function focusAt(x, y) {
  if (!memory || isPressed($("inspect"))) return;
  const size = [canvas.width, canvas.height];
  const registers = toRegisters(view, size);
  const { cell } = await painter.follow(registers.position, pixelDirection(registers, size, ...picture.pixelAt(x, y)));
  if (cell)
    app.glide((now) =>
      focus(
        now,
        cell.map((value) => value + 0.5),
        app.limit(),
      ),
    );
}

const middle = () => {
  const box = canvas.getBoundingClientRect();
  return [box.x + box.width / 2, box.y + box.height / 2];
};
const commands = {
  KeyF: () => app.glide((now) => frame(now, app.bounds(), app.size(), app.limit())),
  KeyR: () => app.glide(firstView),
  KeyO: () => $("statistics").click(),
  KeyP: () => $("save").click(),
  KeyI: () => followAt(...middle()),
  KeyH: () => $("keys").showModal(),
};

function listen() {
  const views = new Views(app);
  for (let i = 0; i < 7; i++) commands[`Digit${i + 1}`] = () => views.choose(i);
  let pressedAt = [0, 0];
  canvas.addEventListener("pointerdown", ({ clientX, clientY }) => {
    pressedAt = [clientX, clientY];
  });
  canvas.addEventListener("click", ({ clientX, clientY }) => {
    if (isPressed($("inspect")) && Math.hypot(clientX - pressedAt[0], clientY - pressedAt[1]) <= CLICK)
      followAt(clientX, clientY);
  });
  canvas.addEventListener("keydown", ({ code }) => {
    if (code === "Enter") $("fullscreen").click();
  });
  $("inspect").onclick = () => {
    pressed($("inspect"), !isPressed($("inspect")));
    document.body.classList.toggle("inspecting", isPressed($("inspect")));
    if (!isPressed($("inspect"))) inspector.clear();
  };
  $("frame").onclick = commands.KeyF;
  $("help").onclick = commands.KeyH;
  $("close").onclick = dismiss;
  makeToolbar($("tools"));
  const setFigures = (on) => {
    pressed($("statistics"), on);
    $("figures").hidden = !on;
  };
  $("statistics").onclick = () => setFigures(!isPressed($("statistics")));
  setFigures(!matchMedia("(max-width: 56rem), (max-height: 30rem)").matches);
  $("toggle-panel").onclick = ({ currentTarget }) =>
    currentTarget.setAttribute("aria-expanded", String(!document.body.classList.toggle("panel-hidden")));
  $("fullscreen").hidden = !document.fullscreenEnabled;
  $("fullscreen").onclick = () =>
    document.fullscreenElement ? document.exitFullscreen() : $("stage").requestFullscreen();
  document.addEventListener("fullscreenchange", () => pressed($("fullscreen"), document.fullscreenElement !== null));

  $("open").onclick = () => $("files").click();
  $("files").onchange = ({ target }) => {
    openFiles(target.files);
    target.value = "";
  };
  let over = 0;
  addEventListener("dragenter", (event) => {
    event.preventDefault();
    over++;
    $("drop").hidden = false;
  });
  addEventListener("dragover", (event) => event.preventDefault());
  addEventListener("dragleave", () => {
    if (--over <= 0) {
      over = 0;
      $("drop").hidden = true;
    }
  });
  addEventListener("drop", async (event) => {
    event.preventDefault();
    over = 0;
    $("drop").hidden = true;
    openFiles(await dropped(event.dataTransfer));
  });
  let soon = null;
  $("depth").oninput = () => {
    showDepth();
    clearTimeout(soon);
    soon = setTimeout(() => build(false), 150);
  };

  $("save-mem").onclick = () => memory && save(memBytes(memory.words), `${memory.name}.mem`, "text/plain");
  $("save-manifest").onclick = () =>
    memory &&
    save(`${JSON.stringify(manifestOf(memory, memory.voxels), null, 2)}\n`, `${memory.name}.json`, "application/json");
  $("save").onclick = () => memory && picture.save(memory.name);
  $("copy").onclick = async () => {
    if (!memory) return;
    history.replaceState(
      null,
      "",
      linkOf({ example: source.example, depth: memory.depth, bake: daylight.options, words: budget.words, view }),
    );
    const done = await navigator.clipboard?.writeText(location.href).then(
      () => true,
      () => false,
    );
    $("copy").textContent = done ? "Copied" : "In the address bar";
    setTimeout(() => {
      $("copy").textContent = "Copy link";
    }, 1500);
  };
  for (const [name, { title }] of Object.entries(examples)) {
    const chip = makeButton($("examples"), title, () =>
      openExample(name).catch((error) => notice("error", "The example cannot be loaded", error.message)),
    );
    chip.dataset.example = name;
    pressed(chip, false);
  }
  makeToolbar($("examples"));
  return makePilot(app, canvas, commands, focusAt);
}

function animate({ gestures, flight }) {
  requestAnimationFrame(() => animate({ gestures, flight }));
  if (!view || !memory) return;
  gestures.step();
  flight.step();
  const gliding = glide.step();
  if (gliding) {
    view = gliding;
    frames.change();
  }
  const rests = frames.step(view, gestures.active || flight.active);
  const busy = String(!rests || gliding !== null);
  if ($("stage").getAttribute("aria-busy") !== busy) $("stage").setAttribute("aria-busy", busy);
}

let boards = {};
let designs = []; // the boards that have bitstreams
let examples = {};
async function start() {
  const [module, { boards: known, designs: placed, examples: scenes }] = await Promise.all([
    WebAssembly.compileStreaming(fetch("voxrt/voxrt.wasm")).catch(async () =>
      WebAssembly.compile(await (await fetch("voxrt/voxrt.wasm")).arrayBuffer()),
    ),
    fetch("site.json").then((answer) => answer.json()),
  ]);
  boards = known;
  designs = placed;
  examples = scenes;
  painter = new Painter(module);
  builder = new Builder(module);
  frames = new FrameRequests(painter, $("stage"));
  light = new Light(app);
  light.hello(painter.hello);
  inspector = new Inspector(app);
  new HardwarePanel(app, module);
  boardPanel = new BoardPanel(app, module);
  painter.addEventListener("frame", ({ detail }) => {
    window.voxrt = {
      newest: detail,
      colours: () => coloursOf(detail),
      view: () => view,
      shownCamera: () => toRegisters(view, [canvas.width, canvas.height]),
    }; // for scripts
    const samples = frames.receive(detail);
    picture.show(detail, samples);
    figures.add(detail, samples);
  });
  painter.addEventListener("trouble", ({ detail }) => notice("error", "There are no frames", detail));
  daylight = new DaylightControl(() => source && build(false));
  budget = new Budget(() => source && build(false));
  const pilot = listen();
  const link = readLink(location.hash);
  if (link.depth) $("depth").value = link.depth;
  if (link.bake) daylight.set(link.bake);
  budget.words = link.words;
  showDepth();
  await openExample(link.example in examples ? link.example : "courtyard");
  if (link.camera && memory) {
    view = { ...view, ...link.camera };
    frames.change();
  }
  animate(pilot);
  setInterval(() => figures.show(), 250);
}
start().catch((error) => notice("error", "The page cannot start", error.message));
