// Makes the bitstream of a board off the page's thread.

import { bitstreamOf, fitBeam } from "./board_bits.js";
import { Hardware } from "./voxrt/hardware.js";
import { FACES, Voxrt } from "./voxrt/voxrt.js";
import { answerWith, count } from "./worker_answers.js";
/** @import { Board, Content } from "./board_bits.js" @import { Lighting } from "./memory.js" */

const OWN = "a shading of its own";

/** @param {string} path */ async function load(path) {
  const answer = await fetch(path);
  if (!answer.ok) throw new Error(`${path}: ${answer.status}`);
  return answer;
}

const calls = {
  /** @param {Content & { module: WebAssembly.Module, name: string, lighting: Lighting }} job @param {(stage: {
   * share: number }) => void} report */
  async bitstream({ module, name, words, depth, materials, lighting }, report) {
    const voxrt = await Voxrt.load(module);
    voxrt.setMemory(words, depth); // which checks the words
    const board = /** @type {Board} */ (await (await load(`boards/${name}.json`)).json());
    refuse(voxrt, board, words, depth);
    const { flat, on, bounces, faces } = lighting;
    if (!flat && String(faces) !== String(FACES))
      throw new Error(`This memory names ${OWN}, which bitstreams of this page have not: voxrt bitstream makes one`);
    const missing = [...(on ? ["light"] : []), ...(bounces ? ["mirrors"] : [])];
    const [base, hardware] = await Promise.all([
      load(`boards/${name}.bit`).then((answer) => answer.arrayBuffer()),
      load(`boards/${board.hardware}.wasm`).then((answer) => Hardware.start(answer)),
    ]);
    hardware.setMemory(words, depth);
    const look = { materials: materials.map(({ colour }) => colour), flat };
    const { scale, framesPerSecond, lead } = fitBeam(voxrt, hardware, board, look, (done, total) =>
      report({ share: done / total }),
    );
    const [width, height] = board.screen.map((side) => side >> scale);
    const bits = bitstreamOf(voxrt, new Uint8Array(base), board, { words, depth, materials }, { flat, scale });
    return { missing, bits, width, height, framesPerSecond, lead, loader: board.loader };
  },
};
/** @typedef {typeof calls} BoardCalls */
answerWith(calls);

/** @param {Voxrt} voxrt @param {Board} board @param {Uint32Array} words @param {number} depth */
function refuse(voxrt, board, words, depth) {
  if (words.length <= board.capacity && depth <= board.depth) return;
  const fits = Math.min(depth - voxrt.levelThatFits(board.capacity), board.depth);
  const memory = `The memory has ${count(words.length)} words and ${depth} levels`;
  const limits = `${board.name} holds ${count(board.capacity)} words and ${board.depth} levels`;
  throw new Error(`${memory}, and ${limits}: choose ${count(2 ** fits)}³ or less, or a budget`);
}
