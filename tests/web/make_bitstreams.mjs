// Bitstreams of boards in Node: {words, depth, materials, flat, name} in; hashes and what the boards show out.
import { answer, fileOf, importOf, sha } from "./jobs.mjs";

const { bitstreamOf, fitBeam } = await importOf("board_bits.js");
const { Hardware } = await importOf("voxrt/hardware.js");
const { Voxrt } = await importOf("voxrt/voxrt.js");
const voxrt = await Voxrt.load(await fileOf("voxrt/voxrt.wasm"));

await answer(async ({ words, depth, materials, flat, name }) => {
  const board = JSON.parse(await fileOf(`boards/${name}.json`));
  const hardware = await Hardware.start(await fileOf(`boards/${board.hardware}.wasm`));
  const memory = { words: Uint32Array.from(words), depth, materials };
  voxrt.setMemory(memory.words, depth);
  hardware.setMemory(memory.words, depth);
  const progress = [];
  const fit = fitBeam(voxrt, hardware, board, { materials: materials.map(({ colour }) => colour), flat }, (done, total) => progress.push(done / total));
  const bits = bitstreamOf(voxrt, await fileOf(`boards/${name}.bit`), board, memory, { flat, scale: fit.scale });
  return { ...fit, bits: sha(bits), progress };
});
