// The memory that is shown, edited: a world in a worker, its patches in the pictures, and at rest the memory that is saved.

import { Hand } from "./hand.js";
import { boundsOf, worldOf } from "./memory.js";
import { partCamera, partOf } from "./projection.js";
import { PatchedWords } from "./patched_words.js";
/** @import { App } from "./app.js" @import { Box } from "./camera.js" @import { Shown } from "./memory.js" */
/** @import { Edited, EditCalls, Stroke } from "./edit_worker.js" @import { Vector } from "./vectors.js" */

const LONG = 0.12; // seconds: a picture that takes longer begins coarsely
const REST = 500; // milliseconds after the last edit until the memory is made of it
const FIGURES = 200; // milliseconds between figures

/** @import { EditFigures } from "./edit_bar.js" */

export class Editor {
  /** @type {Hand<EditCalls>} */ #hand = new Hand("./edit_worker.js");
  /** @type {{ edition: number, box: Box }[]} what pictures of earlier editions lack */ #boxes = [];
  #isRepainting = false;
  #isStale = false;
  #fresh = 0; // blocks of patches since the newest figures
  /** @type {number | null} of the newest figures */ #blocks = null;
  /** @type {ReturnType<typeof setTimeout> | undefined} */ #rest;
  /** @type {ReturnType<typeof setTimeout> | null} */ #soon = null;
  /** @type {PatchedWords | null} the words that workers have */ words = null;

  /** @param {App} app @param {Shown} memory @param {(figures: EditFigures)
   * => void} onFigures */
  constructor(app, memory, onFigures) {
    this.app = app;
    this.original = memory;
    this.materials = memory.materials;
    this.onFigures = onFigures;
    this.ready = this.#start();
  }

  async #start() {
    const { words, depth, materials } = this.original;
    const image = await this.#hand.call("start", { words, depth, materials });
    // Words that store equal blocks twice are edited after these were made one.
    if (image.length !== words.length) await this.app.showWords(image);
    this.words = new PatchedWords(image, depth);
    this.#showFigures();
  }

  /** @param {{ origin: Vector, direction: Vector }} ray */ async pick(ray) {
    await this.ready;
    return this.#hand.call("pick", ray);
  }

  /** @param {Stroke} stroke */ async edit(stroke) {
    await this.ready;
    return this.#take(await this.#hand.call("edit", stroke));
  }

  /** @param {"undo" | "redo"} way */ async move(way) {
    await this.ready;
    return this.#take(await this.#hand.call(way, undefined));
  }

  /** @param {readonly number[]} colour */ async addMaterial(colour) {
    await this.ready;
    const name = `colour #${colour.map((part) => part.toString(16).padStart(2, "0")).join("")}`;
    const material = { name, colour, mirror: false, authored: true };
    const { id, materials } = await this.#hand.call("addMaterial", { material });
    this.materials = materials;
    const memory = this.app.memory();
    if (memory) this.app.revise({ ...memory, materials });
    return id;
  }

  /** @param {Edited} edited */ #take(edited) {
    const { patch, box } = edited;
    if (!patch || !this.words) return edited;
    this.app.inspector.clear();
    this.app.painter.patch(patch);
    this.words.apply(patch);
    this.#boxes.push({ edition: this.app.painter.edition, box });
    this.repaint();
    this.#isStale = true;
    this.#fresh += patch.addresses.length;
    clearTimeout(this.#rest);
    this.#rest = setTimeout(() => this.settle(), REST);
    this.#soon ??= setTimeout(() => this.#showFigures(), FIGURES);
    return edited;
  }

  async #showFigures() {
    this.#soon = null;
    const figures = await this.#hand.call("figures", undefined).catch(() => null);
    if (!figures) return;
    const { blocks } = figures;
    const grown = blocks - (this.#blocks ?? blocks);
    const fresh = Math.max(this.#fresh, grown);
    this.#blocks = blocks;
    this.#fresh = 0;
    this.onFigures({ ...figures, fresh, freed: fresh - grown });
  }

  /** Render what the picture lacks; called after edits and frames. */
  async repaint() {
    if (this.#isRepainting) return;
    this.#isRepainting = true;
    while (await this.#repaintOnce());
    this.#isRepainting = false;
    const { painter, newest, frames } = this.app;
    if (newest?.frame.edition === painter.edition) frames.stage.dataset.edition = String(painter.edition);
  }

  async #repaintOnce() {
    const { painter, picture, frames, newest } = this.app;
    if (!newest) return false;
    const { frame, samples } = newest;
    this.#boxes = this.#boxes.filter(({ edition }) => edition > frame.edition);
    if (!this.#boxes.length) return false;
    const { edition } = painter;
    const boxes = this.#boxes.map(({ box }) => box);
    const low = boxes[0][0].map((_, axis) => Math.min(...boxes.map((box) => box[0][axis])));
    const high = boxes[0][1].map((_, axis) => Math.max(...boxes.map((box) => box[1][axis])));
    const size = [frame.width, frame.height];
    const part = partOf([low, high], frame.camera, size, samples);
    if (this.app.isLit() || (part && frames.resolution.seconds(part.size) > LONG)) {
      this.#boxes = [];
      frames.change();
      return false;
    }
    if (part) {
      const view = { camera: partCamera(frame.camera, size, part), size: part.size };
      const made = await painter.picture(view).catch(() => null);
      if (!made) return false; // another memory came
      if (this.app.newest?.frame !== frame) return true;
      picture.showPart(frame, samples, made, part.at);
    }
    frame.edition = edition;
    return true;
  }

  /** Make the memory of the voxels as they are. */
  async settle() {
    if (!this.#isStale) return;
    this.#isStale = false;
    clearTimeout(this.#rest);
    const made = await Promise.all([
      this.#hand.call("words", undefined),
      this.#hand.call("figures", undefined),
      this.app.painter.census(),
    ]).catch(() => null);
    if (!made) return; // another memory came
    const [words, figures, { voxels, outline }] = made;
    const { original, materials } = this;
    const changed = { words, voxels, bounds: boundsOf(outline) ?? worldOf(original.depth), edited: true, fixed: true };
    const unknown = { manifest: null, objects: [], warnings: [], fitted: null, lossless: null, seconds: undefined };
    const memory = figures.undo ? { ...original, ...unknown, ...changed, materials } : { ...original, materials };
    this.app.revise(memory);
  }

  /** End the worker. */
  end() {
    clearTimeout(this.#rest);
    this.#hand.stop();
  }
}
