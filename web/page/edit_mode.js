// "Edit": the tools Dig, Build and Paint on the picture. This module, and what it imports, is loaded with the first press.

import { showAim } from "./aim.js";
import { EditBar, SIZES } from "./edit_bar.js";
import { EditPointer } from "./edit_pointer.js";
import { Editor } from "./editor.js";
import { $, isPressed, pressed } from "./elements.js";
import { pixelDirection } from "./camera.js";
import { notice } from "./notices.js";
/** @import { App } from "./app.js" @import { Choice } from "./edit_bar.js" @import { Place, Tool } from "./edit_pointer.js" */
/** @import { Gestures } from "./gestures.js" */
/** @import { Commands } from "./tools.js" @import { Walker } from "./walker.js" */

const NARROW = matchMedia("(max-width: 45rem), (max-height: 30rem)"); // the panel would leave little of the picture
const FINE = 5; // levels: the first brush has 1/32 of the world

export class EditMode {
  /** @type {Editor | null} */ #editor = null;
  /** @type {Choice} */ #choice = { tool: "look", size: 1, material: 1 };
  /** @type {Place | null} */ #pointer = null;
  #isAiming = false;
  #isOpen = false;
  #hidPanel = false;

  /** @param {App} app @param {Gestures} gestures @param {Commands} commands @param
   * {Walker} walker */
  constructor(app, gestures, commands, walker) {
    this.app = app;
    this.gestures = gestures;
    this.walker = walker;
    this.bar = new EditBar({
      choose: (some) => this.choose(some),
      addColour: (colour) =>
        this.#try(async () => this.choose({ material: (await this.#editor?.addMaterial(colour)) ?? 1 })),
      move: (way) => this.#try(async () => this.#editor?.move(way)),
    });
    this.pointer = new EditPointer(gestures, {
      tool: (button) => this.#toolOf(button),
      use: (tool, place, stroke) => this.#use(tool, place, stroke),
      aim: (place) => this.#aim(place),
      take: (place) => this.#take(place),
      nextMaterial: (step) => this.#nextMaterial(step),
      locked: () => this.walker.locked,
    });
    Object.assign(commands, {
      KeyX: () => this.#isOpen && this.pointer.once(this.#place()),
      KeyC: () => this.#isOpen && this.#take(this.#place()),
      BracketLeft: () => this.#resize(-1),
      BracketRight: () => this.#resize(1),
      Escape: () => this.choose({ tool: "look" }),
    });
    $("inspect").addEventListener("click", () => isPressed($("inspect")) && this.choose({ tool: "look" }));
    addEventListener("keydown", (event) => this.#press(event));
    addEventListener("beforeunload", (event) => app.memory()?.edited && event.preventDefault());
    app.painter.on("frame", () => {
      this.#editor?.repaint();
      if (this.#choice.tool !== "look") this.#aim(this.#pointer);
    });
    app.editing = this;
  }

  /** Show or hide the controls. Edits stay. */
  toggle() {
    this.#isOpen = !this.#isOpen;
    pressed($("edit-toggle"), this.#isOpen);
    this.bar.box.hidden = !this.#isOpen;
    if (this.#isOpen && !this.#editor) this.#begin();
    const hidesPanel = this.#isOpen && NARROW.matches && !document.body.classList.contains("panel-hidden");
    if (hidesPanel || this.#hidPanel) $("toggle-panel").click();
    this.#hidPanel = hidesPanel;
    this.choose({ tool: this.#isOpen ? "dig" : "look" });
  }

  #begin() {
    const memory = this.app.memory();
    if (!memory) return;
    const used = memory.voxels.map((voxels, id) => ({ voxels: id ? voxels : 0, id }));
    const [most, second] = used.sort((one, other) => other.voxels - one.voxels);
    const material = second?.voxels ? second.id : Math.max(1, most?.id ?? 1);
    this.#choice = { ...this.#choice, size: SIZES.find((size) => size >= 2 ** (memory.depth - FINE)) ?? 1, material };
    const editor = new Editor(this.app, memory, (figures) => this.bar.showFigures(figures));
    this.#editor = editor;
    this.walker.follow(editor);
    editor.ready.catch((error) => this.#editor === editor && this.#fail(error));
    this.bar.showMaterials(memory.materials);
    this.bar.show(this.#choice);
  }

  /** Another memory comes: its edits begin anew. */
  memoryChanged() {
    this.#editor?.end();
    this.#editor = null;
    this.walker.follow(null);
    this.walker.end();
    if (this.#isOpen) this.toggle();
  }

  /** Wait until the memory has all edits. */
  async settle() {
    await this.#editor?.settle();
  }

  /** @param {Partial<Choice>} some */ choose(some) {
    this.#choice = { ...this.#choice, ...some };
    const materials = this.#editor?.materials ?? [];
    if (materials.length - 1 !== this.bar.swatches.childElementCount) this.bar.showMaterials(materials);
    this.bar.show(this.#choice);
    const { tool } = this.#choice;
    if (tool !== "look" && isPressed($("inspect"))) $("inspect").click(); // a click does one thing
    this.gestures.turning = tool === "look" ? 0 : 1;
    document.body.classList.toggle("editing", tool !== "look");
    this.#aim(this.#pointer);
  }

  /** @param {number} button @returns {Tool | null} */ #toolOf(button) {
    const { tool } = this.#choice;
    if (tool === "look" || this.walker.takesPress()) return null;
    if (button !== 2) return tool;
    return tool === "build" ? "dig" : "build";
  }

  /** Where a key works: under the pointer, or in the middle. */
  #place() {
    const { x, y, width, height } = $("picture").getBoundingClientRect();
    return (!this.walker.locked && this.#pointer) || { x: x + width / 2, y: y + height / 2 };
  }

  /** The ray of a place of the picture that is seen. @param {Place} place */ #rayAt({ x, y }) {
    const { newest, picture } = this.app;
    if (!newest) return null;
    const { frame, samples } = newest;
    const [column, row] = picture.pixelAt(x, y).map((pixel) => pixel * samples);
    const size = [frame.width, frame.height];
    if (column < 0 || row < 0 || column >= size[0] || row >= size[1]) return null;
    return { origin: frame.camera.position, direction: pixelDirection(frame.camera, size, column, row) };
  }

  /** @param {Tool} tool @param {Place} place @param {number} stroke */ async #use(tool, place, stroke) {
    const ray = this.#rayAt(this.walker.locked ? this.#place() : place);
    const editor = this.#editor;
    if (!ray || !editor) return null;
    const { size, material } = this.#choice;
    const job = { tool, size, material, stroke, keepOut: this.walker.box(), ...ray };
    const done = await this.#try(() => editor.edit(job));
    this.#aim(this.#pointer ?? place);
    return done;
  }

  /** Show what a tool would change; null for nothing. @param {Place | null} place @returns {Promise<void>} */
  async #aim(place) {
    this.#pointer = place;
    if (this.#isAiming) return;
    const at = this.walker.locked ? this.#place() : place;
    const ray = this.#choice.tool !== "look" && at && this.#rayAt(at);
    if (!ray || !this.#editor) return showAim(null, 1, null);
    this.#isAiming = true;
    const picked = await this.#editor.pick(ray).catch(() => null);
    this.#isAiming = false;
    if (this.#pointer !== place) return this.#aim(this.#pointer);
    showAim(picked, this.#choice.size, this.app.newest?.frame ?? null);
  }

  /** Take the material of a voxel. @param {Place} place */ async #take(place) {
    const ray = this.#rayAt(this.walker.locked ? this.#place() : place);
    const picked = ray && (await this.#editor?.pick(ray));
    if (picked) this.choose({ material: picked.material });
  }

  /** @param {number} step */ #nextMaterial(step) {
    const count = (this.#editor?.materials.length ?? 2) - 1;
    this.choose({ material: ((this.#choice.material - 1 + step + count) % count) + 1 });
  }

  /** @param {number} step */ #resize(step) {
    const at = SIZES.indexOf(this.#choice.size) + step;
    if (this.#isOpen && SIZES[at]) this.choose({ size: SIZES[at] });
  }

  /** @param {KeyboardEvent} event */ #press(event) {
    const isText =
      event.target instanceof Element && event.target.closest("input[type=text], input[type=number], dialog");
    if (!this.#isOpen || isText || !(event.ctrlKey || event.metaKey) || event.altKey) return;
    const key = event.key.toLowerCase();
    const way = key === "y" || (key === "z" && event.shiftKey) ? "redo" : key === "z" ? "undo" : null;
    if (!way) return;
    event.preventDefault();
    this.#try(async () => this.#editor?.move(way));
  }

  /** @template T @param {() => Promise<T>} work @returns {Promise<T | null>} */ async #try(work) {
    try {
      return await work();
    } catch (error) {
      this.#fail(/** @type {Error} */ (error));
      return null;
    }
  }

  /** @param {Error} error */ #fail({ message }) {
    if (message !== "cancelled") notice("error", "The edit is not made", message); // another memory came
  }
}
