// The page: it joins connection, picture, navigation and panel. While this viewer has control, the page owns the view and
// sends it to the server. While another viewer has control, the page follows the view of the server.

import { Advanced } from "./advanced.js";
import { fromRegisters, pixelDirection, toRegisters } from "./camera.js";
import { Connection } from "./connection.js";
import { $, isPressed, makeToolbar, pressed } from "./elements.js";
import { Figures } from "./figures.js";
import { FrameRequests } from "./frame_requests.js";
import { Glide } from "./glide.js";
import { Light } from "./light.js";
import { focus, frame } from "./navigation.js";
import { dismiss, hideAway, notice, showAway } from "./notices.js";
import { Picture } from "./picture.js";
import { makePilot } from "./pilot.js";
import { Player } from "./player.js";
import { Scenes } from "./scenes.js";
import { add, scale } from "./vectors.js";
import { Views } from "./views.js";

const connection = new Connection();
const canvas = $("picture");
const picture = new Picture(canvas);
const figures = new Figures($("figures"));
const frames = new FrameRequests(connection, $("stage"));
const glide = new Glide();
let view = null; // the camera for people of camera.js
let scene = null; // number of the scene to which `view` belongs
let had = false; // control
let unconfirmed = {}; // fields of the view that the state of the server does not have yet

const state = () => connection.state;
const hasControl = () => connection.connected && state()?.controller === connection.hello.viewer;

const app = {
  connection,
  hasControl,
  state,
  view: () => view,
  device: () => connection.hello.device,
  size: () => frames.size,
  side: () => 2 ** state().scene.depth,
  bounds: () => state().scene.bounds ?? [[0, 0, 0], Array(3).fill(app.side())],
  limit: () => Math.min(8 * app.side() + 512, app.device().position_limit / 16 - 1),
  change(how) {
    if (!view || !hasControl()) return;
    glide.stop();
    view = how(view);
    frames.change();
  },
  glide(how) {
    if (view && hasControl()) glide.start(view, how(view), frames.resolution.seconds(frames.size) > 1);
  },
  set(fields) {
    if (!hasControl()) return;
    Object.assign(unconfirmed, fields);
    Object.assign(state().view, fields); // the next change starts from it
    frames.change(fields);
  },
  waits: () => connection.sent.size > 0 || frames.changed,
  fixSize(size) {
    frames.resolution.fixed = size;
  },
  coarsen() {
    if (view) frames.coarsen(view);
  },
};
const player = new Player(app);
const panels = { scenes: new Scenes(app), views: new Views(app), light: new Light(app), advanced: new Advanced(app) };

connection.addEventListener("hello", ({ detail }) => {
  $("connection").dataset.state = "connected";
  $("connection").textContent = detail.device.name;
  hideAway();
  dismiss();
  had = false;
  for (const panel of [panels.scenes, panels.light, panels.advanced]) panel.hello(detail);
});

connection.addEventListener("disconnected", ({ detail }) => {
  $("connection").dataset.state = "disconnected";
  $("connection").textContent = "not connected";
  $("control").textContent = "";
  $("take").hidden = $("release").hidden = true;
  dismiss();
  showAway(detail, detail.retry / 1000);
});
$("token-form").onsubmit = (event) => {
  event.preventDefault();
  connection.useToken(event.target.elements.token.value);
};
$("retry").onclick = () => connection.connectNow();

function showControl({ controller, waiting, viewers }, mine) {
  $("control").dataset.state = mine ? "mine" : "";
  $("control").textContent = mine
    ? waiting.length
      ? `viewer ${waiting[0]} asks for control`
      : viewers > 1
        ? `you have control · ${viewers} viewers`
        : ""
    : controller === null
      ? "nobody has control"
      : `viewer ${controller} has control`;
  $("take").hidden = mine;
  $("take").disabled = waiting.includes(connection.hello.viewer);
  $("take").textContent = $("take").disabled ? "Control requested" : "Take control";
  $("release").hidden = !mine || waiting.length === 0;
  for (const made of document.querySelectorAll(
    "#panel :is(button, input, select), #empty button, #frame, #player :is(button, input), #pad button",
  ))
    if (made.id !== "help") made.disabled = !mine;
}

// The view of registers, with the middle of the scene as target.
function readView(camera, size) {
  const [low, high] = app.bounds();
  return fromRegisters(camera, size, scale(add(low, high), 0.5), frames.size);
}

// Forget the fields that the server has, and keep the others in its view.
function confirm(shown, mine) {
  const same = (name) => JSON.stringify(shown[name]) === JSON.stringify(unconfirmed[name]);
  unconfirmed = mine ? Object.fromEntries(Object.entries(unconfirmed).filter(([name]) => !same(name))) : {};
  Object.assign(shown, unconfirmed);
}

let requested = false; // control, since nobody has it
connection.addEventListener("state", ({ detail }) => {
  const mine = hasControl();
  confirm(detail.view, mine);
  if (!mine || detail.trouble) connection.sent.clear(); // no frame will answer these
  if (detail.controller === null && !requested) connection.request("take").catch(() => {});
  requested = detail.controller === null;
  showControl(detail, mine);
  const another = scene !== detail.scene.number;
  scene = detail.scene.number;
  if (another || !mine || !had || !view) {
    glide.stop();
    frames.discard();
    view =
      another && mine
        ? readView(detail.scene.camera, detail.scene.size)
        : readView(detail.view.camera, detail.view.size);
    if (mine) frames.change();
  }
  had = mine;
  $("scene").textContent = scene === 0 ? "" : detail.scene.name;
  $("details").textContent =
    scene === 0 ? "" : `${2 ** detail.scene.depth}³ voxels · ${detail.scene.words.toLocaleString()} words`;
  canvas.style.backgroundColor = `rgb(${detail.view.background.join()})`;
  panels.scenes.mark(detail);
  player.show(detail);
  panels.light.show(detail);
  panels.advanced.show(detail);
  panels.advanced.showCamera(view);
  $("connection").dataset.state = detail.trouble ? "disconnected" : "connected";
  $("connection").textContent = detail.trouble ? "no frames" : connection.hello.device.name;
  if (detail.trouble) notice("error", "There are no frames", detail.trouble);
});

connection.addEventListener("refused", ({ detail }) => {
  unconfirmed = {};
  notice("error", "The request was refused", detail.problem);
});
connection.addEventListener("frame", ({ detail }) => {
  const samples = frames.receive(detail);
  picture.show(detail, samples, frames.resolution.fixed !== null);
  figures.add(detail, samples);
});

// The voxel under a place of the page becomes the target.
async function focusAt(x, y) {
  if (!view || !hasControl()) return;
  const size = [canvas.width, canvas.height];
  const [column, row] = picture.pixelAt(x, y);
  const registers = toRegisters(view, size);
  try {
    const { hit } = await connection.request("ray", {
      origin: registers.position,
      direction: pixelDirection(registers, size, column, row),
    });
    if (hit) app.glide((now) => focus(now, hit.point, app.limit()));
  } catch (error) {
    notice("error", "There is no point to focus", error.message);
  }
}

const commands = {
  KeyF: () => app.glide((now) => frame(now, app.bounds(), app.size(), app.limit())),
  KeyR: () => app.glide(() => readView(state().scene.camera, state().scene.size)),
  KeyN: () => $("nonstop").click(),
  KeyO: () => $("statistics").click(),
  KeyP: () => $("save").click(),
  KeyH: () => $("keys").showModal(),
};
for (let i = 0; i < 7; i++) commands[`Digit${i + 1}`] = () => panels.views.choose(i);
const { gestures, flight } = makePilot(app, canvas, commands, focusAt);

$("frame").onclick = commands.KeyF;
$("reset").onclick = commands.KeyR;
$("help").onclick = commands.KeyH;
$("take").onclick = () => connection.request("take").catch(() => {});
$("release").onclick = () => connection.request("release").catch(() => {});
$("close").onclick = dismiss;
$("save").onclick = () => picture.save(`${state()?.scene.name ?? "voxrt"}-${figures.newest?.sequence ?? 0}`);
makeToolbar($("tools"));

const setFigures = (on) => {
  pressed($("statistics"), on);
  $("figures").hidden = !on;
};
$("statistics").onclick = ({ currentTarget }) => setFigures(!isPressed(currentTarget));
setFigures(!matchMedia("(max-width: 56rem), (max-height: 30rem)").matches);

$("toggle-panel").onclick = ({ currentTarget }) => {
  const hidden = document.body.classList.toggle("panel-hidden");
  currentTarget.setAttribute("aria-expanded", String(!hidden));
};

$("fullscreen").hidden = !document.fullscreenEnabled;
$("fullscreen").onclick = () =>
  document.fullscreenElement ? document.exitFullscreen() : $("stage").requestFullscreen();
document.addEventListener("fullscreenchange", () => pressed($("fullscreen"), document.fullscreenElement !== null));
canvas.addEventListener("keydown", ({ code }) => {
  if (code === "Enter") $("fullscreen").click();
});

function showWaiting() {
  const { waiting } = hasControl() ? frames : {};
  $("rendering").hidden = !waiting;
  if (!waiting) return;
  const left = Math.ceil(waiting.seconds - (performance.now() - waiting.since) / 1000);
  const text = left > 0 ? `rendering, about ${left} s` : "rendering, a moment more";
  if ($("rendering").textContent !== text) $("rendering").textContent = text;
}

function animate() {
  requestAnimationFrame(animate);
  if (!hasControl() || !view || scene === 0) return;
  gestures.step();
  flight.step();
  player.step();
  const gliding = glide.step();
  if (gliding) {
    view = gliding;
    frames.change();
  }
  const { changed } = frames;
  const rests = frames.step(view, gestures.active || flight.active);
  const busy = String(!rests || gliding !== null);
  if ($("stage").getAttribute("aria-busy") !== busy) $("stage").setAttribute("aria-busy", busy);
  if (changed) panels.advanced.showCamera(view);
}
requestAnimationFrame(animate);
setInterval(() => {
  figures.show();
  showWaiting();
  panels.advanced.readRegisters();
}, 250);
