// The page: it joins connection, picture, camera controls and panel. While this viewer has control, the page owns the
// view and sends it to the server. While another viewer has control, the page follows the view of the server.

import { fromRegisters, toRegisters } from "./camera.js";
import { Connection } from "./connection.js";
import { CameraControls } from "./controls.js";
import { $, Panel, toggled } from "./panel.js";
import { Picture } from "./picture.js";
import { uploadFiles } from "./upload.js";

const connection = new Connection();
const picture = new Picture($("picture"), $("overlay"));
let view = null; // the camera for people of camera.js
let viewChanged = false; // the server does not have `view` yet
let scene = null; // number of the scene to which `view` belongs

const state = () => connection.state;
const hasControl = () => connection.connected && state()?.controller === connection.hello.viewer;
const size = () => state().view.size;

const app = {
  view: () => view,
  size,
  side: () => 2 ** state().scene.depth,
  change(how) {
    if (!view || !hasControl()) return;
    view = how(view);
    viewChanged = true;
  },
  set(fields) { if (hasControl()) connection.changeView(fields); },
  resize(to) { if (hasControl() && view) connection.changeView({ size: to, camera: toRegisters(view, to) }); },
  load(name) { loadScene(name, (report) => connection.request("show", { scene: name }, ({ stage, done, total }) => report(stage, done, total))); },
};
const panel = new Panel(app);

const STAGES = { send: "Sending", read: "Reading", write: "Writing to the board", verify: "Verifying", render: "Rendering the first frame",
  load: "Loading the file", fit: "Fitting the grid", voxelize: "Voxelizing", octree: "Building the octree" };

function notice(kind, title, text = "", progress = null) {
  const box = $("notice");
  box.hidden = false;
  box.dataset.kind = kind;
  box.querySelector("strong").textContent = title;
  box.querySelector("p").textContent = text;
  const bar = box.querySelector("progress");
  bar.hidden = progress === null;
  if (progress !== null) bar.value = progress;
  box.querySelector("button").hidden = kind !== "error";
}
const dismiss = () => { $("notice").hidden = true; };
$("notice").querySelector("button").onclick = dismiss;

// Run what loads another scene, and show its progress.
async function loadScene(name, run) {
  if (!hasControl()) return notice("error", "You do not have control", "Take control before you change the scene.");
  notice("progress", `${name} …`, "", 0);
  try {
    await run((stage, done, total) => notice("progress", `${name} …`, STAGES[stage] ?? stage, total ? done / total : 0));
    dismiss();
  } catch (error) {
    notice("error", `${name} was not loaded`, `${error.message}. The scene has not changed.`);
  }
}
const openFiles = (files) => { if (files.length) loadScene(files[0].name, (report) => uploadFiles(connection, [...files], report)); };

connection.addEventListener("hello", ({ detail }) => {
  $("connection").dataset.state = "connected";
  $("connection").textContent = "connected";
  dismiss();
  panel.hello(detail);
});

connection.addEventListener("disconnected", ({ detail }) => {
  $("connection").dataset.state = "disconnected";
  $("connection").textContent = "not connected";
  $("control").textContent = "";
  $("take").hidden = $("release").hidden = true;
  const reason = detail.code === 1013 ? "The server has too many viewers." : detail.wasConnected ? "The connection was lost."
    : detail.why ? `The server refuses: ${detail.why}.`
    : "No frame server answers, or the token is missing: open the address that the server printed.";
  notice("disconnected", "Not connected to the board", `${reason} The page tries again by itself.`);
});

let requested = false; // control, since nobody has it
connection.addEventListener("state", ({ detail }) => {
  const { controller, waiting, viewers } = detail;
  const mine = controller === connection.hello.viewer;
  if (!mine || detail.trouble) connection.sent.clear(); // no frame will answer these
  if (controller === null && !requested) connection.request("take").catch(() => {});
  requested = controller === null;
  $("control").dataset.state = mine ? "mine" : "";
  $("control").textContent = mine
    ? waiting.length ? `viewer ${waiting[0]} asks for control` : `you have control${viewers > 1 ? ` · ${viewers} viewers` : ""}`
    : controller === null ? "nobody has control" : `viewer ${controller} has control`;
  $("take").hidden = mine;
  $("take").disabled = waiting.includes(connection.hello.viewer);
  $("take").textContent = $("take").disabled ? "Control requested" : "Take control";
  $("release").hidden = !mine || waiting.length === 0;
  if (scene !== detail.scene.number || !mine || !view) {
    scene = detail.scene.number;
    view = fromRegisters(detail.view.camera, detail.view.size);
    viewChanged = false;
  }
  panel.show(detail, mine);
  panel.showCamera(view, detail.view.size);
  $("connection").dataset.state = detail.trouble ? "disconnected" : "connected";
  $("connection").textContent = detail.trouble ? "no frames" : "connected";
  if (detail.trouble) notice("error", "The device has failed", detail.trouble);
  else if (detail.scene.number === 0) notice("hint", "No scene yet", `Drop a file on the picture: ${connection.hello.suffixes.join(" ")}`);
  else if (["hint"].includes($("notice").dataset.kind)) dismiss();
});

connection.addEventListener("refused", ({ detail }) => notice("error", "The request was refused", detail.problem));
connection.addEventListener("frame", ({ detail }) => picture.show(detail));

const commands = {
  KeyR: () => { if (state()) app.change(() => fromRegisters(state().scene.camera, state().scene.size)); },
  KeyN: () => $("nonstop").click(),
  KeyO: () => $("statistics").click(),
  KeyP: () => $("save").click(),
  KeyH: () => $("keys").showModal(),
};
for (let i = 0; i < 7; i++) commands[`Digit${i + 1}`] = () => { if (state()) panel.preset(i); };
const controls = new CameraControls($("picture"), $("pad"), {
  change: app.change,
  world: () => ({ side: app.side(), limit: Math.min(8 * app.side() + 512, connection.hello.device.position_limit / 16 - 1) }),
  commands,
});

$("take").onclick = () => connection.request("take").catch(() => {});
$("release").onclick = () => connection.request("release").catch(() => {});
$("reset").onclick = commands.KeyR;
$("help").onclick = commands.KeyH;
$("save").onclick = () => picture.save(`${state()?.scene.name ?? "voxrt"}-${picture.newest?.sequence ?? 0}`);
$("open").onclick = () => $("files").click();
$("files").onchange = ({ target }) => { openFiles(target.files); target.value = ""; };
$("nonstop").onclick = ({ currentTarget }) => app.set({ nonstop: toggled(currentTarget) });
$("statistics").onclick = ({ currentTarget }) => {
  const on = toggled(currentTarget);
  currentTarget.setAttribute("aria-pressed", String(on));
  $("overlay").hidden = !on;
};
$("toggle-panel").onclick = ({ currentTarget }) => {
  const hidden = document.body.classList.toggle("panel-hidden");
  currentTarget.setAttribute("aria-expanded", String(!hidden));
};

let drags = 0;
addEventListener("dragenter", (event) => { event.preventDefault(); drags += 1; $("drop").hidden = false; });
addEventListener("dragleave", () => { drags -= 1; $("drop").hidden = drags <= 0; });
addEventListener("dragover", (event) => event.preventDefault());
addEventListener("drop", (event) => {
  event.preventDefault();
  drags = 0;
  $("drop").hidden = true;
  openFiles(event.dataTransfer.files);
});

// At most two view changes wait for their frames. Later changes are sent together with the next one.
function animate() {
  if (hasControl() && view) {
    controls.step();
    if (viewChanged && connection.sent.size < 2) {
      viewChanged = false;
      connection.changeView({ camera: toRegisters(view, size()) });
      panel.showCamera(view, size());
    }
  }
  requestAnimationFrame(animate);
}
requestAnimationFrame(animate);

async function readRegisters() {
  if (!$("registers").open || !connection.connected) return;
  try {
    const [{ registers }, { counters }] = await Promise.all([connection.request("registers"), connection.request("counters")]);
    const rows = [...Object.entries(registers), ...Object.entries(counters).map(([name, value]) => [`server ${name}`, value])];
    $("registers").querySelector("tbody").replaceChildren(...rows.map(([name, value]) => {
      const row = document.createElement("tr");
      for (const text of [name, value.toLocaleString()]) row.insertCell().textContent = text;
      return row;
    }));
  } catch { /* the connection was lost; the notice says so */ }
}
$("registers").addEventListener("toggle", readRegisters);
setInterval(() => { picture.showStatistics(); readRegisters(); }, 500);
