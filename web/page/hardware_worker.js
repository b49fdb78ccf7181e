// The verilated hardware off the page's thread, and the exact model beside it.

import { Hardware } from "./voxrt/hardware.js";
import { Voxrt } from "./voxrt/voxrt.js";
import { answerWith, count } from "./worker_answers.js";
/** @import { Rendered } from "./voxrt/hardware.js" @import { Camera, Look, Rows, Size } from "./voxrt/voxrt.js" */

/** @typedef {Rendered & { seconds: number, wrong: number }} Compared `wrong`: pixels in which both differ */

const state = {
  /** @type {{ voxrt: Voxrt, hardware: Hardware } | null} */ loaded: null,
  onProgress: (/** @type {number} */ _pixels) => {},
};

const calls = {
  /** @param {{ module: WebAssembly.Module }} job */ async start({ module }) {
    const path = "voxrt/voxrt_hardware.wasm";
    const [voxrt, hardware] = await Promise.all([
      Voxrt.load(module),
      fetch(path).then((answer) => {
        if (!answer.ok) throw new Error(`${path}: ${answer.status}`);
        return Hardware.start(answer, (pixels) => state.onProgress(pixels));
      }),
    ]);
    state.loaded = { voxrt, hardware };
  },

  /** One frame by both. @param {{ words: Uint32Array, depth: number, camera: Camera, size: Size, look: Look }} job
   * @param {(stage: { share: number }) => void} report */
  run({ words, depth, camera, size, look }, report) {
    if (!state.loaded) throw new Error("the worker has not started");
    const { voxrt, hardware } = state.loaded;
    voxrt.setMemory(words, depth); // which checks the words
    const limit = hardware.wordLimit;
    if (words.length > limit) {
      const fitting = depth - voxrt.levelThatFits(limit);
      const advice = fitting ? `choose ${count(2 ** fitting)}³ or less` : "choose another model";
      const problem = `The memory has ${count(words.length)} words, and the configuration tiny holds ${count(limit)}`;
      throw new Error(`${problem}: ${advice}`);
    }
    hardware.setMemory(words, depth);
    state.onProgress = (pixels) => report({ share: pixels / (size[0] * size[1]) });
    const start = performance.now();
    const made = hardware.render(camera, size, look);
    const seconds = (performance.now() - start) / 1000;
    voxrt.shade(look);
    return { ...made, seconds, wrong: differing(made, voxrt.render(camera, size)) };
  },
};
/** @typedef {typeof calls} HardwareCalls */
answerWith(calls);

/** How many pixels differ in colour, material or face. @param {Rendered} one @param {Rows} other */
function differing(one, other) {
  const isWrong = (/** @type {number} */ _material, /** @type {number} */ i) =>
    one.material[i] !== other.material[i] ||
    one.face[i] !== other.face[i] ||
    [0, 1, 2].some((channel) => one.colour[3 * i + channel] !== other.colour[3 * i + channel]);
  return one.material.filter(isWrong).length;
}
