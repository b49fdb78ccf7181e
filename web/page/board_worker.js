// Makes the bitstream of a board off the page's thread. Messages as of worker.js.

import { bitstreamOf, fitBeam } from "./board_bits.js";
import { answerWith, count } from "./worker_answers.js";
import { Hardware } from "./voxrt/hardware.js";
import { FACES, Voxrt } from "./voxrt/voxrt.js";

let voxrt;

const load = async (path) => {
  const answer = await fetch(path);
  if (!answer.ok) throw new Error(`${path}: ${answer.status}`);
  return answer;
};

answerWith({
  async start({ module }) {
    voxrt = await Voxrt.load(module);
  },

  // `lighting`: as of manifests. Answers {missing, bits, width, height, framesPerSecond, lead, loader}.
  async bitstream({ name, words, depth, materials, lighting }, say) {
    voxrt.setMemory(words, depth); // which checks the words
    const board = await (await load(`boards/${name}.json`)).json();
    refuse(board, words, depth);
    const { flat, on, bounces, faces } = lighting;
    if (!flat && String(faces) !== String(FACES))
      throw new Error(
        "This memory names a shading of its own, which bitstreams of this page have not: voxrt bitstream makes one",
      );
    const missing = [...(on ? ["light"] : []), ...(bounces ? ["mirrors"] : [])];
    const [base, hardware] = await Promise.all([
      load(`boards/${name}.bit`).then((answer) => answer.arrayBuffer()),
      load(`boards/${board.hardware}.wasm`).then((answer) => Hardware.start(answer)),
    ]);
    hardware.setMemory(words, depth);
    const look = { materials: materials.map(({ colour }) => colour), flat };
    const { scale, framesPerSecond, lead } = fitBeam(voxrt, hardware, board, look, (done, total) =>
      say({ share: done / total }),
    );
    const [width, height] = board.screen.map((side) => side >> scale);
    const bits = bitstreamOf(voxrt, new Uint8Array(base), board, { words, depth, materials }, { flat, scale });
    return { missing, bits, width, height, framesPerSecond, lead, loader: board.loader };
  },
});

function refuse(board, words, depth) {
  if (words.length <= board.capacity && depth <= board.depth) return;
  const fits = Math.min(depth - voxrt.levelThatFits(board.capacity), board.depth);
  throw new Error(
    `The memory has ${count(words.length)} words and ${depth} levels, and ${board.name} holds ${count(board.capacity)} words and ${board.depth} levels: choose ${count(2 ** fits)}³ or less, or a budget`,
  );
}
