// One instance of voxrt off the page's thread that has a memory: it renders rows of frames and follows rays.

import { Voxrt } from "./voxrt/voxrt.js";
import { answerWith } from "./worker_answers.js";
/** @import { Camera, Look, Size, Triple } from "./voxrt/voxrt.js" @import { Patch } from "./voxrt/world.js" */

/** @type {Voxrt | null} */ let voxrt = null;

function loaded() {
  if (!voxrt) throw new Error("the worker has not started");
  return voxrt;
}

const calls = {
  /** @param {{ module: WebAssembly.Module }} job */ async start({ module }) {
    voxrt = await Voxrt.load(module);
  },

  /** @param {{ words: Uint32Array, depth: number, shading: Look }} job */ memory({ words, depth, shading }) {
    loaded().setMemory(words, depth);
    loaded().shade(shading);
  },

  /** @param {Patch} patch */ patch(patch) {
    loaded().applyPatch(patch);
  },

  /** @param {{ shading: Look }} job */ shade({ shading }) {
    loaded().shade(shading);
  },

  census() {
    return { voxels: loaded().voxels(), outline: loaded().outline() };
  },

  /** @param {{ camera: Camera, size: Size, first: number, end: number, buffer: ArrayBuffer | null }} job */
  render({ camera, size, first, end, buffer }) {
    return loaded().renderImage(camera, size, first, end, buffer);
  },

  /** @param {{ origin: Triple, direction: Triple }} job */ follow({ origin, direction }) {
    return loaded().follow(origin, direction);
  },
};
/** @typedef {typeof calls} PaintCalls */
answerWith(calls);
