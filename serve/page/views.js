// The views of the scene: six sides and a corner, and those that the user has saved in this browser.

import { FIELD_OF_VIEW, lookAlong } from "./camera.js";
import { $, element, makeButton, makeToolbar, part } from "./elements.js";
import { frame } from "./navigation.js";
/** @import { Pose } from "./camera.js" @import { Page } from "./pilot.js" @import { Commands } from "./tools.js" */
/** @import { Vector } from "./vectors.js" */

/** @type {[string, Vector][]} */ const PRESETS = [
  ["Corner", [-0.62, -0.55, -1]],
  ["Front", [0, 0, -1]],
  ["Back", [0, 0, 1]],
  ["Left", [1, 0, 0]],
  ["Right", [-1, 0, 0]],
  ["Top", [0, -1, 0]],
  ["Bottom", [0, 1, 0]],
];
const SAVED = "voxrt.views";

export class Views {
  /** @param {Page} app */ constructor(app) {
    this.app = app;
    for (const [i, [name]] of PRESETS.entries()) makeButton($("presets"), name, () => this.choose(i), `Key ${i + 1}`);
    makeToolbar($("presets"));
    $("save-view").onsubmit = (event) => {
      event.preventDefault();
      this.save(part($("save-view"), "input"));
    };
    this.show();
  }

  /** The keys of the presets. */
  commands = () => Object.fromEntries(PRESETS.map((_, i) => [`Digit${i + 1}`, () => this.choose(i)]));

  /** @param {number} i */ choose(i) {
    this.app.glide((view) => {
      const turned = lookAlong({ ...view, yaw: 0, fov: FIELD_OF_VIEW.usual }, PRESETS[i][1]);
      return frame(turned, this.app.bounds(), this.app.size(), this.app.limit());
    });
  }

  saved() {
    try {
      return JSON.parse(localStorage.getItem(SAVED) ?? "{}");
    } catch {
      return {};
    }
  }

  /** @param {HTMLInputElement} input */ save(input) {
    const views = this.saved();
    const name = input.value.trim() || `View ${Object.keys(views).length + 1}`;
    localStorage.setItem(SAVED, JSON.stringify({ ...views, [name]: this.app.view() }));
    input.value = "";
    this.show();
  }

  show() {
    $("saved").replaceChildren();
    for (const [name, view] of Object.entries(this.saved())) {
      const row = element("div", { className: "view" });
      makeButton(row, name, () => this.app.glide((now) => ({ ...now, ...view })));
      makeButton(row, "✕", () => this.delete(name), `Delete ${name}`).setAttribute("aria-label", `Delete ${name}`);
      $("saved").append(row);
    }
  }

  /** @param {string} name */ delete(name) {
    const { [name]: _deleted, ...rest } = this.saved();
    localStorage.setItem(SAVED, JSON.stringify(rest));
    this.show();
  }
}
