// "Edit": the tools Dig, Build and Paint on the server's scene, as on the static page; and the scene as files.

import { showAim } from "./aim.js";
import { toRegisters } from "./camera.js";
import { EditBar, SIZES } from "./edit_bar.js";
import { EditPointer } from "./edit_pointer.js";
import { $, isPressed, pressed } from "./elements.js";
import { notice } from "./notices.js";
import { save } from "./save.js";
/** @import { Picked } from "./aim.js" @import { App } from "./app.js" @import { Answer } from "./connection.js" */
/** @import { Choice } from "./edit_bar.js" @import { Place, Tool } from "./edit_pointer.js" */
/** @import { Gestures } from "./gestures.js" @import { State } from "./protocol.js" @import { Commands } from "./tools.js" */
/** @import { Vector } from "./vectors.js" */

const FINE = 5; // levels: the first brush has 1/32 of the world

export class EditTools {
  /** @type {Choice} */ #choice = { tool: "look", size: 1, material: 1 };
  /** @type {Place | null} */ #pointer = null;
  /** @type {Gestures | null} */ #gestures = null;
  /** scene and materials that the swatches show */ #shown = "";
  #words = 0; // of the octree
  #isAiming = false;

  /** @param {App} app */ constructor(app) {
    this.app = app;
    this.bar = new EditBar({
      choose: (some) => this.choose(some),
      addColour: (colour) => this.#addColour(colour),
      move: (op) => this.#edit({ op }),
    });
    $("edit-toggle").onclick = () => this.#toggle();
    for (const suffix of [".mem", ".vox"]) $(`save-${suffix.slice(1)}`).onclick = () => this.#save(suffix);
    app.connection.on("frame", () => this.active && this.#aim(this.#pointer));
  }

  /** Take the mouse and the keys over while a tool is on. @param {Gestures} gestures @param {Commands} commands */
  connect(gestures, commands) {
    this.#gestures = gestures;
    const pointer = new EditPointer(gestures, {
      tool: (button) => this.#toolOf(button),
      use: (tool, place) => this.#use(tool, place),
      aim: (place) => this.#aim(place),
      take: (place) => this.#take(place),
      nextMaterial: (step) => this.#nextMaterial(step),
      locked: () => false,
    });
    Object.assign(commands, {
      KeyB: () => this.#toggle(),
      KeyX: () => pointer.once(this.#place()),
      KeyC: () => this.active && this.#take(this.#place()),
      BracketLeft: () => this.#resize(-1),
      BracketRight: () => this.#resize(1),
      Escape: () => this.choose({ tool: "look" }),
    });
    addEventListener("keydown", (event) => this.#press(event));
  }

  /** Whether clicks edit. */
  get active() {
    return this.#choice.tool !== "look";
  }

  /** @param {State} state */ show({ scene }) {
    const { undo, redo, materials } = scene.edits ?? { undo: 0, redo: 0, materials: 0 };
    const mine = this.app.hasControl();
    this.bar.undo.disabled = !mine || undo === 0;
    this.bar.redo.disabled = !mine || redo === 0;
    Object.assign($("edit-toggle"), { disabled: !mine });
    if (!mine) this.choose({ tool: "look" });
    const shown = `${scene.number} ${materials}`;
    if (!mine || shown === this.#shown) return;
    if (!this.#shown.startsWith(`${scene.number} `)) {
      this.#words = scene.words;
      const size = SIZES.find((one) => one >= 2 ** (scene.depth - FINE)) ?? 1;
      this.#choice = { ...this.#choice, size, material: 1 };
    }
    this.#shown = shown;
    this.#showMaterials();
  }

  /** @param {Partial<Choice>} some */ choose(some) {
    this.#choice = { ...this.#choice, ...some };
    this.bar.show(this.#choice);
    if (this.#gestures) this.#gestures.turning = this.active ? 1 : 0;
    document.body.classList.toggle("editing", this.active);
    this.#aim(this.#pointer);
  }

  #toggle() {
    if (!this.app.hasControl()) return;
    const on = !isPressed($("edit-toggle"));
    pressed($("edit-toggle"), on);
    this.bar.box.hidden = !on;
    this.choose({ tool: on ? "dig" : "look" });
  }

  async #showMaterials() {
    try {
      const { materials } = /** @type {Answer} */ (await this.app.connection.request("materials"));
      this.bar.showMaterials(materials.map(([name, colour]) => ({ name, colour: numbersOf(colour) })));
      this.bar.show(this.#choice);
    } catch (error) {
      notice("error", "The materials are not shown", /** @type {Error} */ (error).message);
    }
  }

  /** @param {number} button @returns {Tool | null} */ #toolOf(button) {
    const { tool } = this.#choice;
    if (tool === "look" || !this.app.hasControl()) return null;
    if (button !== 2) return tool;
    return tool === "build" ? "dig" : "build";
  }

  /** Where a key works: under the pointer, or in the middle. */
  #place() {
    const { x, y, width, height } = $("picture").getBoundingClientRect();
    return this.#pointer ?? { x: x + width / 2, y: y + height / 2 };
  }

  /** @param {Place} place @returns {Promise<(Picked & { material: number }) | null>} */ async #pick({ x, y }) {
    const ray = this.app.rayAt(x, y);
    if (!ray) return null;
    const { hit } = await this.app.connection.request("ray", ray);
    if (!hit) return null;
    const { voxel, face, material } = hit;
    /** @param {number} place @param {number} axis */
    const next = (place, axis) => (axis === face ? place - Math.sign(ray.direction[axis]) : place);
    return { voxel, beside: face === null ? null : voxel.map(next), material };
  }

  /** @param {Tool} tool @param {Place} place */ async #use(tool, place) {
    const picked = await this.#pick(place).catch(() => null);
    if (!picked) return { hit: false };
    const voxel = tool === "build" ? picked.beside : picked.voxel;
    if (voxel?.every((one) => one >= 0 && one < this.app.side())) {
      const { size, material } = this.#choice;
      const op = tool === "paint" ? "paint" : "fill";
      await this.#edit({ op, ...brush(voxel, size), material: tool === "dig" ? 0 : material });
    }
    return { hit: true };
  }

  /** Show what a tool would change; null for nothing. @param {Place | null} place @returns {Promise<void>} */
  async #aim(place) {
    this.#pointer = place;
    if (this.#isAiming) return;
    const pose = this.app.view();
    if (!this.active || !place || !pose) return showAim(null, 1, null);
    this.#isAiming = true;
    const picked = await this.#pick(place).catch(() => null);
    this.#isAiming = false;
    if (this.#pointer !== place) return this.#aim(this.#pointer);
    const [width, height] = [$("picture").width, $("picture").height];
    showAim(picked, this.#choice.size, { width, height, camera: toRegisters(pose, [width, height]) });
  }

  /** Take the material of a voxel. @param {Place} place */ async #take(place) {
    const picked = await this.#pick(place).catch(() => null);
    if (picked) this.choose({ material: picked.material });
  }

  /** @param {number} step */ #nextMaterial(step) {
    const count = this.bar.swatches.childElementCount;
    this.choose({ material: ((this.#choice.material - 1 + step + count) % count) + 1 });
  }

  /** @param {number} step */ #resize(step) {
    const at = SIZES.indexOf(this.#choice.size) + step;
    if (this.active && SIZES[at]) this.choose({ size: SIZES[at] });
  }

  /** @param {KeyboardEvent} event */ #press(event) {
    const isText =
      event.target instanceof Element && event.target.closest("input[type=text], input[type=number], dialog");
    if (this.bar.box.hidden || isText || !(event.ctrlKey || event.metaKey) || event.altKey) return;
    const key = event.key.toLowerCase();
    const op = key === "y" || (key === "z" && event.shiftKey) ? "redo" : key === "z" ? "undo" : null;
    if (!op) return;
    event.preventDefault();
    this.#edit({ op });
  }

  /** @param {number[]} colour */ async #addColour(colour) {
    const text = `#${colour.map((one) => one.toString(16).padStart(2, "0")).join("")}`;
    const figures = await this.#edit({ op: "material", name: text, colour: text });
    if (figures) this.choose({ material: figures.materials - 1 });
  }

  /** @param {object} operation of docs/edit.md */ async #edit(operation) {
    try {
      const { edit } = /** @type {Answer} */ (await this.app.connection.request("edit", { operation }));
      const grown = (edit.words - this.#words) / 8;
      const fresh = Math.max(edit.blocks, grown);
      this.#words = edit.words;
      this.bar.showFigures({ ...edit, blocks: (edit.words - 1) / 8, fresh, freed: fresh - grown });
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

/** The voxels of a tool around one. @param {Vector} voxel @param {number} size */ function brush(voxel, size) {
  if (size === 1) return { box: { low: voxel, high: voxel.map((place) => place + 1) } };
  return { sphere: { centre: voxel.map((place) => place + 0.5), radius: size / 2 } };
}

/** @param {string} colour #rrggbb */ const numbersOf = (colour) =>
  [1, 3, 5].map((at) => Number.parseInt(colour.slice(at, at + 2), 16));
