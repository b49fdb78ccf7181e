// "Edit" on the page of the server: its scene is edited, and saved as files.

import { boxOf, brush, meet } from "./brush.js";
import { toRegisters } from "./camera.js";
import { EditControls } from "./edit_controls.js";
import { $ } from "./elements.js";
import { notice } from "./notices.js";
import { save } from "./save.js";
/** @import { Picked } from "./aim.js" @import { App } from "./app.js" @import { Answer } from "./connection.js" */
/** @import { Use } from "./edit_controls.js" */
/** @import { Place } from "./edit_pointer.js" @import { Gestures } from "./gestures.js" @import { State } from "./protocol.js" */
/** @import { Commands } from "./tools.js" @import { Walker } from "./walker.js" */

export class EditTools {
  /** scene and materials that the swatches show */ #shown = "";
  #words = 0; // of the octree

  /** @param {App} app @param {Gestures} gestures @param {Commands} commands @param {Walker} walker */
  constructor(app, gestures, commands, walker) {
    this.app = app;
    this.controls = new EditControls(gestures, commands, walker, {
      pick: (place) => this.#pick(place),
      use: (use, place) => this.#use(use, place),
      addColour: (colour) => this.#addColour(colour),
      move: (op) => this.#edit({ op }),
      isEditable: () => app.hasControl(),
      frame: () => this.#frame(),
    });
    $("edit-toggle").onclick = () => app.hasControl() && this.controls.toggle();
    commands.KeyB = () => $("edit-toggle").click();
    for (const suffix of [".mem", ".vox"]) $(`save-${suffix.slice(1)}`).onclick = () => this.#save(suffix);
    app.connection.on("frame", () => this.controls.renew());
  }

  /** Whether clicks edit. */
  get active() {
    return this.controls.active;
  }

  /** @param {State} state */ show({ scene }) {
    const { undo, redo, materials } = scene.edits ?? { undo: 0, redo: 0, materials: 0 };
    const mine = this.app.hasControl();
    const { bar } = this.controls;
    bar.undo.disabled = !mine || undo === 0;
    bar.redo.disabled = !mine || redo === 0;
    Object.assign($("edit-toggle"), { disabled: !mine });
    if (!mine && this.active) this.controls.choose({ tool: "look" });
    const shown = `${scene.number} ${materials}`;
    if (!mine || shown === this.#shown) return;
    if (!this.#shown.startsWith(`${scene.number} `)) {
      this.#words = scene.words;
      this.controls.begin(scene.depth, 1);
    }
    this.#shown = shown;
    this.#showMaterials();
  }

  async #showMaterials() {
    const { bar } = this.controls;
    try {
      const { materials } = /** @type {Answer} */ (await this.app.connection.request("materials"));
      bar.showMaterials(materials.map(([name, colour]) => ({ name, colour: numbersOf(colour) })));
      bar.show(this.controls.choice);
    } catch (error) {
      notice("error", "The materials are not shown", /** @type {Error} */ (error).message);
    }
  }

  #frame() {
    const pose = this.app.view();
    const { width, height } = $("picture");
    return pose && { width, height, camera: toRegisters(pose, [width, height]) };
  }

  /** @param {Place} place @returns {Promise<(Picked & { material: number }) | null>} */ async #pick({ x, y }) {
    const ray = this.app.rayAt(x, y);
    const hit = ray && (await this.app.connection.request("ray", ray)).hit;
    if (!hit) return null;
    const { voxel, face, material } = hit;
    /** @param {number} place @param {number} axis */
    const next = (place, axis) => (axis === face ? place - Math.sign(ray.direction[axis]) : place);
    return { voxel, beside: face === null ? null : voxel.map(next), material };
  }

  /** @param {Use} use @param {Place} place */ async #use({ tool, size, material, stroke, keepOut }, place) {
    const picked = await this.#pick(place).catch(() => null);
    if (!picked) return { hit: false };
    const voxel = tool === "build" ? picked.beside : picked.voxel;
    const isFree = !voxel || !keepOut || !meet(boxOf(voxel, size), keepOut);
    if (isFree && voxel?.every((one) => one >= 0 && one < this.app.side())) {
      const op = tool === "paint" ? "paint" : "fill";
      await this.#edit({ op, ...brush(voxel, size), material: tool === "dig" ? 0 : material }, stroke);
    }
    return { hit: true };
  }

  /** @param {number[]} colour */ async #addColour(colour) {
    const text = `#${colour.map((one) => one.toString(16).padStart(2, "0")).join("")}`;
    const figures = await this.#edit({ op: "material", name: text, colour: text });
    return figures && figures.materials - 1;
  }

  /** @param {object} operation of docs/edit.md @param {number} [stroke] edits of one are undone together */
  async #edit(operation, stroke = 0) {
    try {
      const { edit } = /** @type {Answer} */ (await this.app.connection.request("edit", { operation, stroke }));
      const grown = (edit.words - this.#words) / 8;
      const fresh = Math.max(edit.blocks, grown);
      this.#words = edit.words;
      this.controls.bar.showFigures({ ...edit, blocks: (edit.words - 1) / 8, fresh, freed: fresh - grown });
      return edit;
    } catch (error) {
      notice("error", "The edit was refused", /** @type {Error} */ (error).message);
      return null;
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

/** @param {string} colour #rrggbb */ const numbersOf = (colour) =>
  [1, 3, 5].map((at) => Number.parseInt(colour.slice(at, at + 2), 16));
