// The world that is edited, off the page's thread: tools act where a ray hits, and patches come out.
//
// Edits of one stroke, as those while a button is held, are undone together.

import { Voxrt } from "./voxrt/voxrt.js";
import { World } from "./voxrt/world.js";
import { answerWith } from "./worker_answers.js";
/** @import { Box } from "./camera.js" @import { Vector } from "./vectors.js" */
/** @import { Material } from "./voxrt/voxrt.js" @import { Patch, Picked } from "./voxrt/world.js" */

/** @import { Tool } from "./edit_pointer.js" */
/** `size`: voxels across; `keepOut`: where nothing is built, the box of who walks. @typedef {{ tool: Tool, size: number,
 * material: number, keepOut: Box | null, stroke: number, origin: Vector, direction: Vector }} Stroke */

/** `box`: around all voxels that changed; `patch`: null where nothing has changed. @typedef {{ hit: boolean, box: Box,
 * patch: Patch | null }} Edited */

const WORDS = 2 ** 26; // of the memory at least: 256 MiB
const STEPS = 1000; // of undo
/** @type {Box} */ const NOWHERE = [Array(3).fill(0), Array(3).fill(0)];

/** @typedef {{ stroke: number, edits: number, box: Box }} Done a stroke */
/** @type {{ world: World | null, live: number, done: Done[], undone: Done[] }} */
const state = { world: null, live: 0, done: [], undone: [] };

function begun() {
  if (!state.world) throw new Error("the worker has not started");
  return state.world;
}

/** What memories must write to show the world; null where they show it. */
function patch() {
  const made = begun().commit();
  if (made.root === state.live) return null;
  begun().release(state.live);
  state.live = made.root;
  return made;
}

/** @param {Box} one @param {Box} other @returns {Box} */ const around = ([low, high], [otherLow, otherHigh]) => [
  low.map((place, axis) => Math.min(place, otherLow[axis])),
  high.map((place, axis) => Math.max(place, otherHigh[axis])),
];

/** @param {Box} one @param {Box} other */ const meet = ([low, high], [otherLow, otherHigh]) =>
  low.every((place, axis) => place < otherHigh[axis] && otherLow[axis] < high[axis]);

/** The voxels of a tool around one. @param {Vector} voxel @param {number} size */ function brush(voxel, size) {
  if (size === 1) return { box: { low: voxel, high: voxel.map((place) => place + 1) } };
  return { sphere: { centre: voxel.map((place) => place + 0.5), radius: size / 2 } };
}

/** @param {Vector} voxel @param {number} size @returns {Box} */ const boxOf = (voxel, size) => [
  voxel.map((place) => Math.floor(place + (1 - size) / 2)),
  voxel.map((place) => Math.ceil(place + (1 + size) / 2)),
];

/** Go back, or forth again, by a stroke. @param {Done[]} from @param {Done[]} to @param {() => boolean} step */
function move(from, to, step) {
  const last = from.at(-1);
  if (!last) return { hit: true, box: NOWHERE, patch: null };
  let edits = 0;
  while (edits < last.edits && step()) edits++; // the first one alone can find no room
  from.pop();
  if (edits) to.push({ ...last, edits });
  return { hit: true, box: last.box, patch: patch() };
}

const calls = {
  /** Returns the words that the patches change. @param {{ words: Uint32Array, depth: number, materials:
   * Required<Material>[] }} memory */
  async start(memory) {
    const answer = await fetch(new URL("voxrt/voxrt_edit.wasm", import.meta.url));
    if (!answer.ok) throw new Error(`voxrt_edit.wasm: the server answers ${answer.status}`);
    const voxrt = await Voxrt.load(answer);
    const limits = { words: Math.max(WORDS, 2 * memory.words.length), undoSteps: STEPS };
    state.world = new World(voxrt, memory, limits);
    return state.world.image();
  },

  /** @param {{ origin: Vector, direction: Vector }} ray @returns {Picked | null} */ pick({ origin, direction }) {
    return begun().pick(origin, direction);
  },

  /** @param {Stroke} job @returns {Edited} */ edit({ tool, size, material, keepOut, stroke, origin, direction }) {
    const found = begun().pick(origin, direction);
    const voxel = tool === "build" ? found?.beside : found?.voxel;
    if (!voxel) return { hit: found !== null, box: NOWHERE, patch: null };
    const box = boxOf(voxel, size);
    if (tool === "build" && keepOut && meet(box, keepOut)) return { hit: true, box, patch: null };
    if (tool === "paint") begun().paint(brush(voxel, size), material);
    else begun().fill(brush(voxel, size), tool === "dig" ? 0 : material);
    const made = patch();
    if (made) {
      const last = state.done.at(-1);
      if (last?.stroke === stroke) Object.assign(last, { edits: last.edits + 1, box: around(last.box, box) });
      else state.done.push({ stroke, edits: 1, box });
      if (state.done.length > STEPS) state.done.shift();
      state.undone = [];
    }
    return { hit: true, box, patch: made };
  },

  /** @returns {Edited} */ undo() {
    return move(state.done, state.undone, () => begun().undo());
  },

  /** @returns {Edited} */ redo() {
    return move(state.undone, state.done, () => begun().redo());
  },

  /** @param {{ material: Required<Material> }} job */ addMaterial({ material }) {
    return { id: begun().addMaterial(material), materials: begun().materials };
  },

  figures() {
    return { ...begun().figures(), undo: state.done.length, redo: state.undone.length };
  },

  words() {
    return begun().words();
  },
};
/** @typedef {typeof calls} EditCalls */
answerWith(calls);
