// One instance of voxrt off the page's thread: it builds memories, renders rows of frames, follows rays.

import { FLAT } from "./memory.js";
import { Voxrt } from "./voxrt/voxrt.js";
import { answerWith } from "./worker_answers.js";
/** @import { DroppedFile } from "./folder.js" @import { ReadFile } from "./files.js" */
/** @import { Memory } from "./memory.js" @import { Camera, Look, Options, Size, Triple } from "./voxrt/voxrt.js" */

const state = {
  /** @type {Voxrt | null} */ voxrt: null,
  /** @type {{ source: number, read: ReadFile } | null} the files that were read last */ parsed: null,
};

function loaded() {
  if (!state.voxrt) throw new Error("the worker has not started");
  return state.voxrt;
}

/** Read files; those that were read last are not read again. @param {DroppedFile[]} files @param {number} source */
async function read(files, source) {
  if (state.parsed?.source !== source) {
    const { readFiles } = await import("./files.js");
    state.parsed = null;
    state.parsed = { source, read: await readFiles(files, loaded()) };
  }
  return state.parsed.read;
}

const calls = {
  /** @param {{ module: WebAssembly.Module }} job */ async start({ module }) {
    state.voxrt = await Voxrt.load(module);
  },

  /** @param {Required<Omit<Options, "colours">> & { files: DroppedFile[], source: number }} job @param {(stage:
   * string) => void} report */
  async build({ files, source, depth, fill, bake, budget }, report) {
    if (state.parsed?.source !== source) report("Reading");
    const { name, file, memory, scene } = await read(files, source);
    if (memory) return { ...memory, name, file, fixed: true };
    const start = performance.now();
    report(`Voxelizing ${(2 ** depth).toLocaleString("en")}³`);
    const built = loaded().voxelize(scene, { depth, fill, bake, budget });
    const seconds = (performance.now() - start) / 1000;
    const warnings = [...scene.warnings, ...built.warnings];
    return { ...built, name, file, fill, seconds, warnings, lighting: built.baked ? FLAT : null };
  },

  /** @param {{ words: Uint32Array, depth: number, shading: Look }} job */ memory({ words, depth, shading }) {
    loaded().setMemory(words, depth);
    loaded().shade(shading);
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
/** @typedef {typeof calls} WorkerCalls */
answerWith(calls);
