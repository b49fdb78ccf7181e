// The verilated hardware in Node: {site, words, depth, camera, size, look} in; hashes, clocks and problems out.
import { createHash } from "node:crypto";
import { readFile } from "node:fs/promises";
import { pathToFileURL } from "node:url";

const { site, jobs } = JSON.parse(await new Response(process.stdin).text());
const at = (path) => pathToFileURL(`${site}/${path}`).href;
const { Hardware } = await import(at("voxrt/hardware.js"));
const { Voxrt } = await import(at("voxrt/voxrt.js"));
const module = await WebAssembly.compile(await readFile(`${site}/voxrt/voxrt_hardware.wasm`));
const voxrt = await Voxrt.load(await readFile(`${site}/voxrt/voxrt.wasm`));
const sha = (bytes) => createHash("sha256").update(bytes).digest("hex");

let pixels = [];
const hardware = await Hardware.start(module, (ready) => pixels.push(ready));
const results = [];
for (const { words, zeros, depth, camera, size, look, limit } of jobs) {
  pixels = [];
  try {
    hardware.setMemory(zeros ? new Uint32Array(zeros) : Uint32Array.from(words), depth);
    const { colour, material, face, clocks, wordsRead } = hardware.render(camera, size, look);
    voxrt.setMemory(Uint32Array.from(words), depth);
    results.push({ colour: sha(colour), material: sha(material), face: sha(face), clocks, wordsRead, pixels, level: voxrt.levelThatFits(limit) });
  } catch (error) {
    results.push({ problem: error.message, limit: hardware.wordLimit });
  }
}
console.log(JSON.stringify(results));
