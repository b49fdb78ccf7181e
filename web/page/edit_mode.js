// "Edit" on the static page: a world in a worker is edited. This module, and what it imports, is loaded with the first press
// of "Edit" or "Walk".

import { pixelDirection } from "./camera.js";
import { EditControls } from "./edit_controls.js";
import { Editor } from "./editor.js";
import { $, isPressed } from "./elements.js";
import { MemoryGround } from "./memory_ground.js";
import { notice } from "./notices.js";
import { Walker } from "./walker.js";
/** @import { App } from "./app.js" @import { Use } from "./edit_controls.js" @import { Place } from "./edit_pointer.js" */
/** @import { Flight } from "./flight.js" @import { Gestures } from "./gestures.js" */
/** @import { Commands } from "./tools.js" */

export class EditMode {
  /** @type {Editor | null} */ #editor = null;

  /** @param {App} app @param {Gestures} gestures @param {Flight} flight @param {Commands} commands */
  constructor(app, gestures, flight, commands) {
    this.app = app;
    this.ground = new MemoryGround(app);
    this.walker = new Walker(app, flight, this.ground);
    this.controls = new EditControls(gestures, commands, this.walker, {
      pick: (place) => this.#pick(place),
      use: (use, place) => this.#use(use, place),
      addColour: (colour) => this.#try(() => this.#addColour(colour)),
      move: (way) => this.#try(async () => this.#editor?.move(way)),
      isEditable: () => true,
      frame: () => app.newest?.frame ?? null,
    });
    const look = () => this.controls.choose({ tool: "look" });
    $("inspect").addEventListener("click", () => isPressed($("inspect")) && look());
    addEventListener("beforeunload", (event) => app.memory()?.edited && event.preventDefault());
    app.painter.on("frame", () => {
      this.#editor?.repaint();
      this.controls.renew();
    });
    app.editing = this;
  }

  /** Show or hide the controls. Edits stay. */
  toggle() {
    const { controls } = this;
    if (!controls.isOpen && !this.#editor) this.#begin();
    controls.toggle();
  }

  #begin() {
    const memory = this.app.memory();
    if (!memory) return;
    const used = memory.voxels.map((voxels, id) => ({ voxels: id ? voxels : 0, id }));
    const [most, second] = used.sort((one, other) => other.voxels - one.voxels);
    const material = second?.voxels ? second.id : Math.max(1, most?.id ?? 1);
    const { bar } = this.controls;
    const editor = new Editor(this.app, memory, (figures) => bar.showFigures(figures));
    this.#editor = editor;
    this.ground.editor = editor;
    editor.ready.catch((error) => this.#editor === editor && this.#fail(error));
    bar.showMaterials(memory.materials);
    this.controls.begin(memory.depth, material);
  }

  /** Another memory comes: its edits begin anew. */
  memoryChanged() {
    this.#editor?.end();
    this.#editor = null;
    this.ground.editor = null;
    this.walker.end();
    if (this.controls.isOpen) this.toggle();
  }

  /** Wait until the memory has all edits. */
  async settle() {
    await this.#editor?.settle();
  }

  /** @param {number[]} colour */ async #addColour(colour) {
    if (!this.#editor) return null;
    const id = await this.#editor.addMaterial(colour);
    this.controls.bar.showMaterials(this.#editor.materials);
    return id;
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

  /** @param {Place} place */ async #pick(place) {
    const ray = this.#rayAt(place);
    return (ray && (await this.#editor?.pick(ray))) ?? null;
  }

  /** @param {Use} use @param {Place} place */ async #use(use, place) {
    const [ray, editor] = [this.#rayAt(place), this.#editor];
    return ray && editor && this.#try(() => editor.edit({ ...use, ...ray }));
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
