// The verilated hardware off the page's thread, and the exact model beside it. Messages as of worker.js.

import { answerWith, count } from "./worker_answers.js";
import { Hardware } from "./voxrt/hardware.js";
import { Voxrt } from "./voxrt/voxrt.js";

let voxrt, hardware;
let onProgress = () => {};

answerWith({
  async start({ module }) {
    [voxrt, hardware] = await Promise.all([
      Voxrt.load(module),
      fetch("voxrt/voxrt_hardware.wasm").then((answer) => {
        if (!answer.ok) throw new Error(`voxrt/voxrt_hardware.wasm: ${answer.status}`);
        return Hardware.start(answer, (pixels) => onProgress(pixels));
      }),
    ]);
  },

  // One frame by both. Answers the hardware's picture, what it took, and how many pixels differ in colour, material or
  // face.
  run({ words, depth, camera, size, look }, say) {
    voxrt.setMemory(words, depth); // which checks the words
    const limit = hardware.wordLimit;
    if (words.length > limit) {
      const fitting = depth - voxrt.levelThatFits(limit);
      throw new Error(
        `The memory has ${count(words.length)} words, and the configuration tiny holds ${count(limit)}: ${
          fitting ? `choose ${count(2 ** fitting)}³ or less` : "choose another model"
        }`,
      );
    }
    hardware.setMemory(words, depth);
    onProgress = (pixels) => say({ share: pixels / (size[0] * size[1]) });
    const start = performance.now();
    const made = hardware.render(camera, size, look);
    const seconds = (performance.now() - start) / 1000;
    voxrt.shade(look);
    return { ...made, seconds, wrong: differing(made, voxrt.render(camera, size)) };
  },
});

function differing(one, other) {
  let wrong = 0;
  for (let i = 0; i < one.material.length; i++)
    if (
      one.material[i] !== other.material[i] ||
      one.face[i] !== other.face[i] ||
      [0, 1, 2].some((channel) => one.colour[3 * i + channel] !== other.colour[3 * i + channel])
    )
      wrong++;
  return wrong;
}
