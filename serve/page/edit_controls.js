// "Edit", as both pages have it: the tools by mouse, fingers and keys, their choice, and a frame on what they would change.

import { showAim } from "./aim.js";
import { EditBar, SIZES } from "./edit_bar.js";
import { EditPointer } from "./edit_pointer.js";
import { $, isPressed, pressed } from "./elements.js";
/** @import { Picked } from "./aim.js" @import { Box, Registers } from "./camera.js" */
/** @import { Choice } from "./edit_bar.js" @import { Place, Tool } from "./edit_pointer.js" */
/** @import { Gestures } from "./gestures.js" @import { Commands } from "./tools.js" @import { Walker } from "./walker.js" */

const FINE = 5; // levels: the first brush has 1/32 of the world
const NARROW = matchMedia("(max-width: 45rem), (max-height: 30rem)"); // the panel would leave little of the picture

/** `keepOut`: where nothing is built, the box of who walks. @typedef {{ tool: Tool, size: number, material: number,
 * stroke: number, keepOut: Box | null }} Use */

/** What is edited. `pick`: what the ray of a place hits; `use`: what a tool does there; `addColour`: the id of a new
 * material; `frame`: the picture that is seen. They report errors, and answer null then. @typedef {{ pick: (place: Place) =>
 * Promise<(Picked & { material: number }) | null>, use: (use: Use, place: Place) => Promise<{ hit: boolean } | null>,
 * addColour: (colour: number[]) => Promise<number | null>, move: (way: "undo" | "redo") => void, isEditable: () =>
 * boolean, frame: () => { width: number, height: number, camera: Registers } | null }} Edits */

export class EditControls {
  /** @type {Choice} */ choice = { tool: "look", size: 1, material: 1 };
  /** @type {Place | null} */ #pointer = null;
  #isAiming = false;
  #hidPanel = false;

  /** @param {Gestures} gestures @param {Commands} commands @param {Walker} walker @param {Edits} edits */
  constructor(gestures, commands, walker, edits) {
    this.gestures = gestures;
    this.walker = walker;
    this.edits = edits;
    this.bar = new EditBar({
      choose: (some) => this.choose(some),
      addColour: (colour) => this.#addColour(colour),
      move: (way) => edits.move(way),
    });
    const pointer = new EditPointer(gestures, {
      tool: (button) => this.#toolOf(button),
      use: (tool, place, stroke) => this.#use(tool, place, stroke),
      aim: (place) => this.#aim(place),
      take: (place) => this.#take(place),
      nextMaterial: (step) => this.#nextMaterial(step),
      locked: () => walker.locked,
    });
    Object.assign(commands, {
      KeyX: () => this.isOpen && pointer.once(this.#at(this.#pointer)),
      KeyC: () => this.isOpen && this.#take(this.#at(this.#pointer)),
      BracketLeft: () => this.#resize(-1),
      BracketRight: () => this.#resize(1),
      Escape: () => this.choose({ tool: "look" }),
    });
    addEventListener("keydown", (event) => this.#press(event));
  }

  get isOpen() {
    return !this.bar.box.hidden;
  }

  /** Whether clicks edit. */
  get active() {
    return this.choice.tool !== "look";
  }

  /** Show or hide the controls. */
  toggle() {
    this.bar.box.hidden = this.isOpen;
    pressed($("edit-toggle"), this.isOpen);
    const hidesPanel = this.isOpen && NARROW.matches && !document.body.classList.contains("panel-hidden");
    if (hidesPanel || this.#hidPanel) $("toggle-panel").click();
    this.#hidPanel = hidesPanel;
    this.choose({ tool: this.isOpen ? "dig" : "look" });
  }

  /** Another scene: its brush and its material. @param {number} depth levels @param {number} material */
  begin(depth, material) {
    const size = SIZES.find((one) => one >= 2 ** (depth - FINE)) ?? 1;
    this.choice = { ...this.choice, size, material };
    this.bar.show(this.choice);
  }

  /** @param {Partial<Choice>} some */ choose(some) {
    this.choice = { ...this.choice, ...some };
    this.bar.show(this.choice);
    this.gestures.turning = this.active ? 1 : 0;
    document.body.classList.toggle("editing", this.active);
    const inspect = document.getElementById("inspect");
    if (this.active && inspect && isPressed(inspect)) inspect.click(); // a click does one thing
    this.#aim(this.#pointer);
  }

  /** Aim again, at another picture. */
  renew() {
    if (this.active) this.#aim(this.#pointer);
  }

  /** @param {number} button @returns {Tool | null} */ #toolOf(button) {
    const { tool } = this.choice;
    if (tool === "look" || !this.edits.isEditable() || this.walker.takesPress()) return null;
    if (button !== 2) return tool;
    return tool === "build" ? "dig" : "build";
  }

  /** Where something works: at a place, or in the middle. @param {Place | null} place */ #at(place) {
    const { x, y, width, height } = $("picture").getBoundingClientRect();
    return (!this.walker.locked && place) || { x: x + width / 2, y: y + height / 2 };
  }

  /** @param {Tool} tool @param {Place} place @param {number} stroke */ async #use(tool, place, stroke) {
    const { size, material } = this.choice;
    const use = { tool, size, material, stroke, keepOut: tool === "build" ? this.walker.box() : null };
    const done = await this.edits.use(use, this.#at(place));
    this.#aim(this.#pointer ?? place);
    return done;
  }

  /** Show what a tool would change; null for nothing. @param {Place | null} place @returns {Promise<void>} */
  async #aim(place) {
    this.#pointer = place;
    if (this.#isAiming) return;
    if (!this.active || !(place || this.walker.locked)) return showAim(null, 1, null);
    this.#isAiming = true;
    const picked = await this.edits.pick(this.#at(place)).catch(() => null);
    this.#isAiming = false;
    if (this.#pointer !== place) return this.#aim(this.#pointer);
    showAim(picked, this.choice.size, this.edits.frame());
  }

  /** Take the material of a voxel. @param {Place} place */ async #take(place) {
    const picked = await this.edits.pick(this.#at(place)).catch(() => null);
    if (picked) this.choose({ material: picked.material });
  }

  /** @param {number[]} colour */ async #addColour(colour) {
    const material = await this.edits.addColour(colour);
    if (material !== null) this.choose({ material });
  }

  /** @param {number} step */ #nextMaterial(step) {
    const count = this.bar.swatches.childElementCount;
    this.choose({ material: ((this.choice.material - 1 + step + count) % count) + 1 });
  }

  /** @param {number} step */ #resize(step) {
    const at = SIZES.indexOf(this.choice.size) + step;
    if (this.isOpen && SIZES[at]) this.choose({ size: SIZES[at] });
  }

  /** @param {KeyboardEvent} event */ #press(event) {
    const isText =
      event.target instanceof Element && event.target.closest("input[type=text], input[type=number], dialog");
    if (!this.isOpen || isText || !(event.ctrlKey || event.metaKey) || event.altKey) return;
    const key = event.key.toLowerCase();
    const way = key === "y" || (key === "z" && event.shiftKey) ? "redo" : key === "z" ? "undo" : null;
    if (!way) return;
    event.preventDefault();
    this.edits.move(way);
  }
}
