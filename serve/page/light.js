// The light of the scene: shading, shadows of a lamp, mirrors, background.

import { $, all, makeButton, makeSlider, makeToolbar, pressed } from "./elements.js";
import { add, clamp, length, scale, subtract } from "./vectors.js";
/** @import { Page } from "./pilot.js" @import { Device } from "./protocol.js" @import { Vector } from "./vectors.js" */

/** How hits are coloured; `light`: the place of the lamp in 1/16 voxel. `shading`: faces, report or flat;
 * `features`: some of: light, mirrors; `background`: sRGB. @typedef {{ shading: string, features: string[], light:
 * Vector, ambient: number, bounces: number, background: number[] }} Look */

/** @typedef {{ view: Look, scene: { depth: number } }} LitState */
/** @typedef {Page & { device(): Device, state(): LitState, set(fields: Partial<Look>): void }} LitPage */

/** @type {Record<string, string[]>} */ const SHADINGS = {
  faces: ["Faces", "Each face has its own brightness; tops are the brightest"],
  report: ["Report", "Faces that turn away are darker, as in the report on the original hardware"],
  flat: ["Flat", "Materials show their own colour"],
};
const FEATURES = { light: ["Shadows", "A lamp casts shadows"], mirrors: ["Mirrors", "Mirror materials reflect"] };
const FAR = 1.5; // from the middle of the scene to the lamp, in diagonals of the scene
const DEGREE = Math.PI / 180;

export class Light {
  /** @param {LitPage} app */ constructor(app) {
    this.app = app;
    /** @param {string} label @param {number} min @param {number} max @param {(value: number) => void} onInput */
    const slider = (label, min, max, onInput) => makeSlider($("light"), label, { min, max, step: 1 }, onInput);
    this.direction = slider("Direction", -180, 180, (value) => this.move({ direction: value }));
    this.height = slider("Height", 0, 90, (value) => this.move({ height: value }));
    this.ambient = slider("Ambient", 0, 255, (value) => app.set({ ambient: clamp(Math.round(value), 0, 255) }));
    /** @param {number} i @param {number} value */
    const moved = (i, value) => app.state().view.light.map((old, j) => (j === i ? Math.round(value * 16) : old));
    this.place = [0, 1, 2].map((i) =>
      makeSlider($("light-place"), "XYZ"[i], { step: 0.0625 }, (value) => app.set({ light: moved(i, value) }), true),
    );
    $("background").oninput = () =>
      app.set({ background: [1, 3, 5].map((at) => Number.parseInt($("background").value.slice(at, at + 2), 16)) });
    $("bounces").oninput = () => {
      if ($("bounces").value !== "") app.set({ bounces: clamp(Math.round($("bounces").valueAsNumber), 0, 15) });
    };
    for (const [name, [label, title]] of Object.entries(SHADINGS))
      makeButton($("shading"), label, () => app.set({ shading: name }), title).dataset.shading = name;
    for (const name of ["shading", "features"]) makeToolbar($(name));
  }

  middle() {
    const [low, high] = this.app.bounds();
    return { centre: scale(add(low, high), 0.5), far: FAR * length(subtract(high, low)) };
  }

  /** Degrees around the scene, 0 in front and 90 at the right, and above the ground. */
  angles() {
    const [x, y, z] = subtract(scale(this.app.state().view.light, 1 / 16), this.middle().centre);
    return { direction: Math.atan2(x, z) / DEGREE, height: Math.atan2(y, Math.hypot(x, z)) / DEGREE };
  }

  /** @param {{ direction?: number, height?: number }} changed */ move(changed) {
    const { direction, height } = { ...this.angles(), ...changed };
    const { centre, far } = this.middle();
    const level = Math.cos(height * DEGREE);
    const [sine, cosine] = [Math.sin(direction * DEGREE), Math.cos(direction * DEGREE)];
    const towards = [level * sine, Math.sin(height * DEGREE), level * cosine];
    const limit = this.app.device().position_limit - 1;
    this.app.set({ light: add(centre, towards, far).map((place) => clamp(Math.round(place * 16), -limit, limit)) });
  }

  /** Show what the device can do. @param {{ device: Device }} hello */
  hello({ device }) {
    $("features").replaceChildren();
    for (const [name, [label, title]] of Object.entries(FEATURES)) {
      if (!device.features.includes(name)) continue;
      const change = () => {
        const on = this.app.state().view.features;
        this.app.set({ features: on.includes(name) ? on.filter((other) => other !== name) : [...on, name].sort() });
      };
      const toggle = makeButton($("features"), label, change, title);
      toggle.dataset.feature = name;
      pressed(toggle, false);
    }
  }

  /** @param {LitState} state */ show({ view, scene }) {
    for (const made of all("button", $("shading"))) pressed(made, made.dataset.shading === view.shading);
    $("shading-says").textContent = `${SHADINGS[view.shading]?.[1] ?? ""}.`;
    for (const made of all("button", $("features"))) pressed(made, view.features.includes(made.dataset.feature ?? ""));
    const lit = view.features.includes("light");
    $("light").hidden = $("light-place").hidden = !lit;
    $("bounces-row").hidden = !view.features.includes("mirrors");
    if (document.activeElement !== $("background"))
      $("background").value = `#${view.background.map((part) => part.toString(16).padStart(2, "0")).join("")}`;
    if (document.activeElement !== $("bounces")) $("bounces").valueAsNumber = view.bounces;
    const side = 2 ** scene.depth;
    this.place.forEach((slider, i) => {
      slider.range(-2 * side, 3 * side);
      slider.set(view.light[i] / 16);
    });
    this.ambient.set(view.ambient);
    const { direction, height } = this.angles();
    this.direction.set(Math.round(direction));
    this.height.set(Math.round(height));
  }
}
