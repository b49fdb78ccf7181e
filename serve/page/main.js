// The page: line, picture, steering and panel put together. The view lives here; the server's is followed while
// another viewer steers.

import { fromRegisters, toRegisters } from "./camera.js";
import { Link } from "./link.js";
import { $, Panel, toggled } from "./panel.js";
import { Picture } from "./picture.js";
import { Steering } from "./steering.js";
import { upload } from "./upload.js";

const link = new Link();
const picture = new Picture($("picture"), $("overlay"));
let view = null; // what we want to see
let wanted = false; // whether the server has still to hear of it
let scene = null; // number of the scene that `view` is of

const state = () => link.state;
const steers = () => link.live && state()?.controller === link.hello.viewer;
const size = () => state().view.size;

const app = {
  view: () => view,
  size,
  side: () => 2 ** state().scene.depth,
  change(how) {
    if (!view || !steers()) return;
    view = how(view);
    wanted = true;
  },
  set(fields) { if (steers()) link.change(fields); },
  resize(to) { if (steers() && view) link.change({ size: to, camera: toRegisters(view, to) }); },
  show(name) { work(name, (report) => link.ask("show", { scene: name }, ({ stage, done, total }) => report(stage, done, total))); },
};
const panel = new Panel(app);

const STAGES = { send: "Sending", read: "Reading", write: "Writing to the board", verify: "Reading back",
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
  box.querySelector("button").hidden = kind !== "trouble";
}
const dismiss = () => { $("notice").hidden = true; };
$("notice").querySelector("button").onclick = dismiss;

// Something that takes long and puts another scene on.
async function work(name, run) {
  if (!steers()) return notice("trouble", "You do not steer", "Take control first; then the scene can be changed.");
  notice("work", `${name} …`, "", 0);
  try {
    await run((stage, done, total) => notice("work", `${name} …`, STAGES[stage] ?? stage, total ? done / total : 0));
    dismiss();
  } catch (error) {
    notice("trouble", `${name} was not put on`, `${error.message}. The scene that ran before still runs.`);
  }
}
const openFiles = (files) => { if (files.length) work(files[0].name, (report) => upload(link, [...files], report)); };

link.addEventListener("hello", ({ detail }) => {
  $("link").dataset.state = "live";
  $("link").textContent = "live";
  dismiss();
  panel.hello(detail);
});

link.addEventListener("away", ({ detail }) => {
  $("link").dataset.state = "away";
  $("link").textContent = "away";
  $("steering").textContent = "";
  $("take").hidden = $("pass").hidden = true;
  const why = detail.code === 1013 ? "It has too many viewers." : detail.was ? "The connection broke." : "No frame server answers, or it wants its token: open the address that it printed.";
  notice("away", "The board is away", `${why} Trying again by itself.`);
});

let asked = false;
link.addEventListener("state", ({ detail }) => {
  const { controller, waiting, viewers } = detail;
  const mine = controller === link.hello.viewer;
  if (!mine || detail.trouble) link.sent.clear(); // their frames will not come
  if (controller === null && !asked) link.ask("take").catch(() => {});
  asked = controller === null;
  $("steering").dataset.state = mine ? "mine" : "";
  $("steering").textContent = mine
    ? waiting.length ? `viewer ${waiting[0]} asks to steer` : `you steer${viewers > 1 ? ` · ${viewers} viewers` : ""}`
    : controller === null ? "nobody steers" : `viewer ${controller} steers`;
  $("take").hidden = mine;
  $("take").disabled = waiting.includes(link.hello.viewer);
  $("take").textContent = $("take").disabled ? "Asked for control" : "Take control";
  $("pass").hidden = !mine || waiting.length === 0;
  if (scene !== detail.scene.number || !mine || !view) {
    scene = detail.scene.number;
    view = fromRegisters(detail.view.camera, detail.view.size);
    wanted = false;
  }
  panel.show(detail, mine);
  panel.showCamera(view, detail.view.size);
  if (detail.trouble) notice("trouble", "The device is in trouble", detail.trouble);
  else if (detail.scene.number === 0) notice("hint", "No scene yet", `Drop a file on the picture: ${link.hello.suffixes.join(" ")}`);
  else if (["hint"].includes($("notice").dataset.kind)) dismiss();
});

link.addEventListener("refused", ({ detail }) => notice("trouble", "The board refused", detail.problem));
link.addEventListener("frame", ({ detail }) => picture.show(detail));

const commands = {
  KeyR: () => { if (state()) app.change(() => fromRegisters(state().scene.camera, state().scene.size)); },
  KeyN: () => $("nonstop").click(),
  KeyO: () => $("figures").click(),
  KeyP: () => $("save").click(),
  KeyH: () => $("keys").showModal(),
};
for (let i = 0; i < 7; i++) commands[`Digit${i + 1}`] = () => { if (state()) panel.preset(i); };
const steering = new Steering($("picture"), $("pad"), {
  change: app.change,
  world: () => ({ side: app.side(), limit: Math.min(8 * app.side() + 512, link.hello.device.position_limit / 16 - 1) }),
  commands,
});

$("take").onclick = () => link.ask("take").catch(() => {});
$("pass").onclick = () => link.ask("release").catch(() => {});
$("reset").onclick = commands.KeyR;
$("help").onclick = commands.KeyH;
$("save").onclick = () => picture.save(`${state()?.scene.name ?? "voxrt"}-${picture.newest?.sequence ?? 0}`);
$("open").onclick = () => $("files").click();
$("files").onchange = ({ target }) => { openFiles(target.files); target.value = ""; };
$("nonstop").onclick = ({ currentTarget }) => app.set({ nonstop: toggled(currentTarget) });
$("figures").onclick = ({ currentTarget }) => {
  const on = toggled(currentTarget);
  currentTarget.setAttribute("aria-pressed", String(on));
  $("overlay").hidden = !on;
};
$("fold").onclick = ({ currentTarget }) => {
  const folded = document.body.classList.toggle("folded");
  currentTarget.setAttribute("aria-expanded", String(!folded));
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

// No more than two views under way: what is steered meanwhile goes out with the next one.
function animate() {
  if (steers() && view) {
    steering.step();
    if (wanted && link.sent.size < 2) {
      wanted = false;
      link.change({ camera: toRegisters(view, size()) });
      panel.showCamera(view, size());
    }
  }
  requestAnimationFrame(animate);
}
requestAnimationFrame(animate);

async function readRegisters() {
  if (!$("registers").open || !link.live) return;
  try {
    const [{ registers }, { counters }] = await Promise.all([link.ask("registers"), link.ask("counters")]);
    const rows = [...Object.entries(registers), ...Object.entries(counters).map(([name, value]) => [`server ${name}`, value])];
    $("registers").querySelector("tbody").replaceChildren(...rows.map(([name, value]) => {
      const row = document.createElement("tr");
      for (const text of [name, value.toLocaleString()]) row.insertCell().textContent = text;
      return row;
    }));
  } catch { /* the board went away; the notice says so */ }
}
$("registers").addEventListener("toggle", readRegisters);
setInterval(() => { picture.figures(); readRegisters(); }, 500);
