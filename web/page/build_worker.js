// One instance of voxrt off the page's thread that builds memories.

import { extension } from "./folder.js";
import { FLAT } from "./memory.js";
import { placed } from "./placing.js";
import { Voxrt } from "./voxrt/voxrt.js";
import { answerWith } from "./worker_answers.js";
/** @import { DroppedFile } from "./folder.js" @import { ReadFile, ReadScene } from "./files.js" */
/** @import { Stage } from "./build_notice.js" @import { Placing } from "./placing.js" */
/** @import { Options } from "./voxrt/voxrt.js" */

/** @typedef {Required<Omit<Options, "colours">>} BuildOptions */

const LONG = 10; // levels: builds of more are estimated by one of fewer
const FEWER = 3; // levels
const RUIN = 0.1; // part of the surface: a budget that changes more has a finest resolution that fits without loss

const state = {
  /** @type {Voxrt | null} */ voxrt: null,
  /** @type {{ source: number, read: ReadFile } | null} the files that were read last */ parsed: null,
  /** @type {{ of: string, seconds: number } | null} what the newest build took, as one of depth 0 */ pace: null,
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

  /** @param {BuildOptions & Placing & { files: DroppedFile[], source: number }} job @param {(stage: Stage) => void}
   * report */
  async build({ files, source, up, unit, ...options }, report) {
    if (state.parsed?.source !== source) report({ text: "Reading" });
    const { name, file, memory, scene: found } = await read(files, source);
    if (memory) return { ...memory, name, file, fixed: true };
    const scene = placed(found, extension(file), { up, unit });
    const { depth, fill, rule } = options;
    const of = JSON.stringify([source, { ...options, depth: null }]);
    if (depth >= LONG && state.pace?.of !== of) timed(scene, { ...options, depth: depth - FEWER }, of);
    const seconds = state.pace?.of === of ? state.pace.seconds * 4 ** depth : undefined;
    report({ text: `Voxelizing ${(2 ** depth).toLocaleString("en")}³`, seconds });
    const built = timed(scene, options, of);
    const { fitted } = built;
    const isRuin = fitted !== null && fitted.changed > RUIN * fitted.surface;
    const warnings = [...scene.warnings, ...built.warnings].filter(({ kind }) => up === null || kind !== "up-axis");
    const lossless = isRuin ? finestThatFits(scene, options, fitted.words) : null;
    return { ...built, name, file, fill, rule, up, unit, warnings, lossless, lighting: built.baked ? FLAT : null };
  },
};

/** The finest resolution whose memory has at most so many words without a budget. @param {ReadScene} scene @param
 * {BuildOptions} options @param {number} most words */
function finestThatFits(scene, options, most) {
  for (let depth = options.depth - 1; depth > 0; depth--) {
    const { words } = loaded().voxelize(scene, { ...options, depth, budget: null });
    if (words.length <= most) return { depth, words: words.length };
  }
  return null;
}

/** @param {ReadScene} scene @param {BuildOptions} options @param {string} of what is built, and how */
function timed(scene, options, of) {
  const start = performance.now();
  const built = loaded().voxelize(scene, options);
  const seconds = (performance.now() - start) / 1000;
  state.pace = { of, seconds: seconds / 4 ** options.depth };
  return { ...built, seconds };
}

/** @typedef {typeof calls} BuildCalls */
answerWith(calls);
