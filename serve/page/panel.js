// The panel beside the picture. It is made once; then its controls follow the view.

import { axes, faceWorld, fieldOfView, focal, lookAlong } from "./camera.js";

export const $ = (id) => document.getElementById(id);

export const PRESETS = [
  ["Corner", [-0.62, -0.68, -1]], ["Front", [0, 0, -1]], ["Back", [0, 0, 1]], ["Left", [1, 0, 0]], ["Right", [-1, 0, 0]],
  ["Top", [0, -1, 0]], ["Bottom", [0, 1, 0]],
];
const FEATURES = { light: "Shadows", mirrors: "Mirrors" };
const SHADINGS = { faces: "By face", flat: "Flat colours", report: "By angle" };
const SIZES = [[320, 240], [512, 512], [640, 480], [800, 600], [1280, 720], [1920, 1080]];
const SAVED = "voxrt.views";

function field(parent, label, first, { min, max, step }, onInput) {
  const row = document.createElement("div");
  row.className = first ? "field first" : "field";
  const name = document.createElement("span");
  name.textContent = label;
  const inputs = ["range", "number"].map((type) => {
    const input = document.createElement("input");
    Object.assign(input, { type, min, max, step });
    input.setAttribute("aria-label", label);
    input.addEventListener("input", () => { if (input.value !== "") onInput(Number(input.value)); });
    return input;
  });
  row.append(name, ...inputs);
  parent.append(row);
  return {
    set(value) { for (const input of inputs) if (input !== document.activeElement || input.type === "range") input.value = value; },
    range(low, high) { inputs[0].min = low; inputs[0].max = high; },
  };
}

const pressed = (button, on) => button.setAttribute("aria-pressed", String(on));
export const toggled = (button) => button.getAttribute("aria-pressed") !== "true";

function button(parent, label, onClick, title = "") {
  const made = document.createElement("button");
  Object.assign(made, { type: "button", textContent: label, title });
  made.addEventListener("click", onClick);
  parent.append(made);
  return made;
}

// `app` has view(), size(), side(), change(f), set(fields) for all but the camera, resize(size), and load(name).
export class Panel {
  constructor(app) {
    this.app = app;
    const camera = $("camera");
    const axis = (i) => "xyz"[i].toUpperCase();
    this.position = [0, 1, 2].map((i) => field(camera, `Position ${axis(i)}`, i === 0, { step: 0.0625 }, (value) =>
      app.change((view) => ({ ...view, eye: view.eye.map((old, j) => (j === i ? value : old)) }))));
    this.direction = [0, 1, 2].map((i) => field(camera, `Direction ${axis(i)}`, i === 0, { min: -1, max: 1, step: 0.001 }, (value) =>
      app.change((view) => lookAlong(view, axes(view).look.map((old, j) => (j === i ? value : old))))));
    this.magnitude = field(camera, "Magnitude", true, { min: 50, max: 4000, step: 1 }, (value) =>
      app.change((view) => ({ ...view, fov: Math.min(140, Math.max(5, fieldOfView(Math.max(1, value), app.size()))) })));
    this.fov = field(camera, "Field of view", false, { min: 5, max: 140, step: 0.1 }, (value) =>
      app.change((view) => ({ ...view, fov: Math.min(140, Math.max(5, value)) })));
    $("flip-x").onclick = () => app.change((view) => ({ ...view, flipX: !view.flipX }));
    $("flip-y").onclick = () => app.change((view) => ({ ...view, flipY: !view.flipY }));
    PRESETS.forEach(([name], i) => button($("presets"), name, () => this.preset(i), `Key ${i + 1}`));
    $("save-view").onsubmit = (event) => { event.preventDefault(); this.saveView(event.target.elements.name); };
    $("background").oninput = ({ target }) =>
      app.set({ background: [1, 3, 5].map((at) => parseInt(target.value.slice(at, at + 2), 16)) });
    $("bounces").oninput = ({ target }) => { if (target.value !== "") app.set({ bounces: Math.round(Number(target.value)) }); };
    $("size").onchange = ({ target }) => app.resize(target.value.split("x").map(Number));
    this.light = [0, 1, 2].map((i) => field($("light"), `Light ${axis(i)}`, i === 0, { step: 0.0625 }, (value) =>
      app.set({ light: this.state.view.light.map((old, j) => (j === i ? Math.round(value * 16) : old)) })));
    this.ambient = field($("light"), "Ambient", false, { min: 0, max: 255, step: 1 }, (value) =>
      app.set({ ambient: Math.min(255, Math.max(0, Math.round(value))) }));
    this.showSaved();
  }

  preset(i) { this.app.change((view) => ({ ...faceWorld(this.app.side(), PRESETS[i][1]), flipX: view.flipX, flipY: view.flipY })); }

  // Show the features of the device and the list of scenes.
  hello({ device, scenes, suffixes }) {
    $("device").textContent = `${device.name} · ${device.capacity.toLocaleString()} words · depth ${device.depth}`;
    $("formats").textContent = `Opens ${suffixes.join(" ")}. You can also drop files on the picture.`;
    $("files").accept = [...suffixes, ".json", ".bin", ".mtl", ".png", ".jpg"].join(",");
    $("library").replaceChildren();
    for (const name of scenes) button($("library"), name, () => this.app.load(name)).dataset.scene = name;
    $("features").replaceChildren();
    for (const [name, label] of Object.entries(SHADINGS))
      button($("features"), label, () => this.app.set({ shading: name })).dataset.shading = name;
    for (const [name, label] of Object.entries(FEATURES)) {
      if (!device.features.includes(name)) continue;
      const toggle = button($("features"), label, () => {
        const on = this.state.view.features;
        this.app.set({ features: on.includes(name) ? on.filter((other) => other !== name) : [...on, name] });
      });
      toggle.dataset.feature = name;
      pressed(toggle, false);
    }
    $("light").hidden = !device.features.includes("light");
    $("bounces-row").hidden = !device.features.includes("mirrors");
    this.maxSize = device.size;
    this.widthStep = device.width_step;
  }

  // Show the state of the server, all but the camera.
  show(state, hasControl) {
    this.state = state;
    const { view, scene } = state;
    $("scene").textContent = `${scene.name} · ${2 ** scene.depth}³ voxels · ${scene.words.toLocaleString()} words`;
    for (const made of $("library").children) made.classList.toggle("chosen", made.dataset.scene === scene.name);
    for (const made of $("features").children) pressed(made, made.dataset.shading === view.shading || view.features.includes(made.dataset.feature));
    if (document.activeElement !== $("background"))
      $("background").value = `#${view.background.map((part) => part.toString(16).padStart(2, "0")).join("")}`;
    if (document.activeElement !== $("bounces")) $("bounces").value = view.bounces;
    pressed($("nonstop"), view.nonstop);
    const now = view.size.join("x");
    const sizes = SIZES.filter((size) => size.every((part, i) => part <= this.maxSize[i]) && size[0] % this.widthStep === 0)
      .map((size) => size.join("x"));
    if (!sizes.includes(now)) sizes.push(now);
    if ($("size").options.length !== sizes.length || $("size").value !== now)
      $("size").replaceChildren(...sizes.map((size) => new Option(size.replace("x", " × "), size, false, size === now)));
    const side = 2 ** scene.depth;
    this.position.forEach((slider) => slider.range(-2 * side, 3 * side));
    this.light.forEach((slider, i) => { slider.range(-2 * side, 3 * side); slider.set(view.light[i] / 16); });
    this.ambient.set(view.ambient);
    for (const made of $("panel").querySelectorAll("button, input, select"))
      if (!["statistics", "help", "save"].includes(made.id)) made.disabled = !hasControl;
  }

  showCamera(view, size) {
    const { look } = axes(view);
    this.position.forEach((slider, i) => slider.set(Math.round(view.eye[i] * 16) / 16));
    this.direction.forEach((slider, i) => slider.set(look[i].toFixed(3)));
    this.magnitude.set(Math.round(focal(view.fov, size)));
    this.fov.set(view.fov.toFixed(1));
    pressed($("flip-x"), view.flipX);
    pressed($("flip-y"), view.flipY);
  }

  saved() {
    try { return JSON.parse(localStorage.getItem(SAVED)) ?? {}; } catch { return {}; }
  }

  saveView(input) {
    const views = this.saved();
    const name = input.value.trim() || `View ${Object.keys(views).length + 1}`;
    localStorage.setItem(SAVED, JSON.stringify({ ...views, [name]: this.app.view() }));
    input.value = "";
    this.showSaved();
  }

  showSaved() {
    $("saved").replaceChildren();
    for (const [name, view] of Object.entries(this.saved())) {
      const row = document.createElement("div");
      row.className = "view";
      button(row, name, () => this.app.change(() => view));
      button(row, "✕", () => {
        const { [name]: _gone, ...rest } = this.saved();
        localStorage.setItem(SAVED, JSON.stringify(rest));
        this.showSaved();
      }, `Delete ${name}`);
      $("saved").append(row);
    }
  }
}
