// What few people need: numbers of the camera, size of the frames, registers and counters.

import { axes, FIELD_OF_VIEW, fieldOfView, focal, lookAlong } from "./camera.js";
import { $, element, isPressed, makeSlider, part, pressed } from "./elements.js";
import { clamp } from "./vectors.js";
/** @import { App } from "./app.js" @import { Hello, State } from "./protocol.js" */
/** @import { Limits, OnNumber } from "./elements.js" @import { Vector } from "./vectors.js" */

const SIZES = ["320x240", "512x512", "640x480", "800x600", "1280x720", "1920x1080"];

export class Advanced {
  /** @param {App} app */ constructor(app) {
    this.app = app;
    /** @param {string} label @param {Limits} limits @param {OnNumber} onInput */
    const slider = (label, limits, onInput) => makeSlider($("camera"), label, limits, onInput, true);
    /** @param {Vector} triple @param {number} i @param {number} value */
    const replaced = (triple, i, value) => triple.map((old, j) => (j === i ? value : old));
    /** @param {number} fov */
    const zoomed = (fov) => app.change((view) => ({ ...view, fov: clamp(fov, FIELD_OF_VIEW.min, FIELD_OF_VIEW.max) }));
    this.position = [0, 1, 2].map((i) =>
      slider(`Position ${"XYZ"[i]}`, { step: 0.0625 }, (value) =>
        app.change((view) => ({ ...view, eye: replaced(view.eye, i, clamp(value, -app.limit(), app.limit())) })),
      ),
    );
    this.direction = [0, 1, 2].map((i) =>
      slider(`Direction ${"XYZ"[i]}`, { min: -1, max: 1, step: 0.001 }, (value) =>
        app.change((view) => lookAlong(view, replaced(axes(view).look, i, value))),
      ),
    );
    this.magnitude = slider("Magnitude", { min: 50, max: 4000, step: 1 }, (value) =>
      zoomed(fieldOfView(Math.max(1, value), app.size())),
    );
    this.fov = slider("Field of view", { min: FIELD_OF_VIEW.min, max: FIELD_OF_VIEW.max, step: 0.1 }, zoomed);
    $("flip-x").onclick = () => app.change((view) => ({ ...view, flipX: !view.flipX }));
    $("flip-y").onclick = () => app.change((view) => ({ ...view, flipY: !view.flipY }));
    $("size").onchange = () => {
      const { value } = $("size");
      app.fixSize(value === "stage" ? null : value.split("x").map(Number));
    };
    $("nonstop").onclick = () => app.set({ nonstop: !isPressed($("nonstop")) });
    $("advanced").addEventListener("toggle", () => this.readRegisters());
  }

  /** @param {Hello} hello */ hello({ device }) {
    const sizes = SIZES.map((text) => text.split("x").map(Number));
    const fits = (/** @type {number[]} */ [width, height]) =>
      width <= device.size[0] && height <= device.size[1] && width % device.width_step === 0;
    const options = sizes.filter(fits).map((size) => new Option(size.join(" × "), size.join("x")));
    $("size").replaceChildren(new Option("as the page", "stage"), ...options);
    this.app.fixSize(null);
  }

  /** @param {State} state */ show({ view, scene }) {
    const side = 2 ** scene.depth;
    for (const slider of this.position) slider.range(-2 * side, 3 * side);
    pressed($("nonstop"), view.nonstop);
    this.showCamera();
  }

  showCamera() {
    const view = this.app.view();
    if (!view || !$("advanced").open) return;
    const { look } = axes(view);
    for (const [i, slider] of this.position.entries()) slider.set(Math.round(view.eye[i] * 16) / 16);
    for (const [i, slider] of this.direction.entries()) slider.set(look[i].toFixed(3));
    this.magnitude.set(Math.round(focal(view.fov, this.app.size())));
    this.fov.set(view.fov.toFixed(1));
    pressed($("flip-x"), view.flipX);
    pressed($("flip-y"), view.flipY);
  }

  async readRegisters() {
    const { connection } = this.app;
    if (!$("advanced").open || !connection.connected) return;
    try {
      const [{ registers }, { counters }] = await Promise.all([
        connection.request("registers"),
        connection.request("counters"),
      ]);
      const named = Object.entries(counters).map(([name, value]) => /** @type {const} */ ([`server ${name}`, value]));
      const rows = [...Object.entries(registers), ...named].map(([name, value]) =>
        element("tr", {}, element("td", {}, name), element("td", {}, value.toLocaleString())),
      );
      part($("registers"), "tbody").replaceChildren(...rows);
    } catch {
      // The connection was lost, and the page shows it.
    }
  }
}
