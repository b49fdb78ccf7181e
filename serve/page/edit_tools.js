// Edits of the server's scene: a click digs a voxel or builds one, with the material beside it; undo; the scene as files.

import { $, isPressed, makeToolbar, pressed } from "./elements.js";
import { notice } from "./notices.js";
import { save } from "./save.js";
/** @import { App } from "./app.js" @import { Answer } from "./connection.js" @import { State } from "./protocol.js" */

const TOOLS = /** @type {const} */ (["dig", "build"]);
const CLICK = 6; // pixels that a pointer may move

export class EditTools {
  /** @param {App} app */ constructor(app) {
    this.app = app;
    makeToolbar($("edit"));
    for (const tool of TOOLS)
      $(tool).onclick = () => {
        const on = !isPressed($(tool));
        for (const one of TOOLS) pressed($(one), on && one === tool);
      };
    $("undo").onclick = () => this.#edit({ op: "undo" });
    $("redo").onclick = () => this.#edit({ op: "redo" });
    for (const suffix of [".mem", ".vox"]) $(`save-${suffix.slice(1)}`).onclick = () => this.#save(suffix);
    let began = { x: 0, y: 0 };
    $("picture").addEventListener("pointerdown", ({ clientX, clientY }) => {
      began = { x: clientX, y: clientY };
    });
    $("picture").addEventListener("click", ({ clientX, clientY }) => {
      if (Math.hypot(clientX - began.x, clientY - began.y) <= CLICK) this.#use(clientX, clientY);
    });
  }

  /** Whether clicks edit. */
  get active() {
    return TOOLS.some((tool) => isPressed($(tool)));
  }

  /** @param {State} state */ show({ scene }) {
    const mine = this.app.hasControl();
    const { undo, redo } = scene.edits ?? { undo: 0, redo: 0 };
    Object.assign($("undo"), { disabled: !mine || undo === 0 });
    Object.assign($("redo"), { disabled: !mine || redo === 0 });
  }

  /** Dig or build at a place of the page. @param {number} x @param {number} y */
  async #use(x, y) {
    const ray = this.active && this.app.hasControl() ? this.app.rayAt(x, y) : null;
    if (!ray) return;
    try {
      const { hit } = await this.app.connection.request("ray", ray);
      if (!hit) return;
      const place = [...hit.voxel];
      if (!isPressed($("build"))) {
        await this.#edit({ op: "set", points: [place], materials: 0 });
      } else if (hit.face !== null) {
        place[hit.face] -= Math.sign(ray.direction[hit.face]);
        if (place.every((one) => one >= 0 && one < this.app.side()))
          await this.#edit({ op: "set", points: [place], materials: hit.material });
      }
    } catch (error) {
      notice("error", "There is no voxel to edit", /** @type {Error} */ (error).message);
    }
  }

  /** @param {object} operation of docs/edit.md */ async #edit(operation) {
    try {
      await this.app.connection.request("edit", { operation });
    } catch (error) {
      notice("error", "The edit was refused", /** @type {Error} */ (error).message);
    }
  }

  /** @param {string} suffix */ async #save(suffix) {
    const { connection } = this.app;
    try {
      const { files } = /** @type {Answer} */ (await connection.request("save", { suffix }));
      const size = files.reduce((sum, file) => sum + file.size, 0);
      /** @type {Uint8Array<ArrayBuffer>[]} */ const parts = [];
      for (let at = 0; at < size; at += parts[parts.length - 1].length) parts.push(await connection.part(at));
      const all = new Blob(parts);
      let start = 0;
      for (const file of files) {
        save(all.slice(start, start + file.size), file.name);
        start += file.size;
      }
    } catch (error) {
      notice("error", "The scene was not saved", /** @type {Error} */ (error).message);
    }
  }
}
