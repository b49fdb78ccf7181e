// Bitstreams of boards in Node: {site, words, depth, materials, boards} in; hashes and what the boards show out.
import { createHash } from "node:crypto";
import { readFile } from "node:fs/promises";
import { pathToFileURL } from "node:url";

const { site, jobs } = JSON.parse(await new Response(process.stdin).text());
const at = (path) => pathToFileURL(`${site}/${path}`).href;
const { bitstreamOf, fitBeam } = await import(at("board_bits.js"));
const { Hardware } = await import(at("voxrt/hardware.js"));
const { Voxrt } = await import(at("voxrt/voxrt.js"));
const voxrt = await Voxrt.load(await readFile(`${site}/voxrt/voxrt.wasm`));

const results = [];
for (const { words, depth, materials, flat, name } of jobs) {
  const board = JSON.parse(await readFile(`${site}/boards/${name}.json`));
  const hardware = await Hardware.start(await readFile(`${site}/boards/${board.hardware}.wasm`));
  const memory = { words: Uint32Array.from(words), depth, materials };
  voxrt.setMemory(memory.words, depth);
  hardware.setMemory(memory.words, depth);
  const progress = [];
  const fit = fitBeam(voxrt, hardware, board, { materials: materials.map(({ colour }) => colour), flat }, (done, total) => progress.push(done / total));
  const bits = bitstreamOf(voxrt, await readFile(`${site}/boards/${name}.bit`), board, memory, { flat, scale: fit.scale });
  results.push({ ...fit, bits: createHash("sha256").update(bits).digest("hex"), progress });
}
console.log(JSON.stringify(results));
