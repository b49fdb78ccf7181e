// The world that is edited, off the page's thread: tools act where a ray hits, and patches come out.

import { around, boxOf, brush, meet } from "./brush.js";
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

/** @typedef {{ stroke: number, box: Box }} Done a step of undo, and where its voxels are */
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

/** Go back, or forth again, by a stroke. @param {Done[]} from @param {Done[]} to @param {() => boolean} step */
function move(from, to, step) {
  const turned = step();
  const last = from.pop();
  if (!turned || !last) return { hit: true, box: NOWHERE, patch: null };
  to.push(last);
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
    begun().stroke = stroke;
    if (tool === "paint") begun().paint(brush(voxel, size), material);
    else begun().fill(brush(voxel, size), tool === "dig" ? 0 : material);
    const made = patch();
    if (made) {
      const last = state.done.at(-1);
      if (last?.stroke === stroke) last.box = around(last.box, box);
      else state.done.push({ stroke, box });
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
    const [undo, redo] = begun().steps;
    return { ...begun().figures(), undo, redo };
  },

  words() {
    return begun().words();
  },
};
/** @typedef {typeof calls} EditCalls */
answerWith(calls);
