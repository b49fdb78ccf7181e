// What the page does with dropped files, in Node: reads jobs from standard input and prints what came out, as JSON.
//
// job: {site, files, depth, fill, bake, budget, frames: [{camera, size, shading}]}
import { createHash } from "node:crypto";
import { readFile } from "node:fs/promises";
import { basename } from "node:path";
import { pathToFileURL } from "node:url";

globalThis.self = globalThis;
globalThis.ProgressEvent ??= class extends Event {};

const text = await new Response(process.stdin).text();
const { site, jobs } = JSON.parse(text);
const at = (path) => pathToFileURL(`${site}/${path}`).href;
const { Voxrt } = await import(at("voxrt/voxrt.js"));
const { readFiles } = await import(at("files.js"));
const module = await WebAssembly.compile(await readFile(`${site}/voxrt/voxrt.wasm`));
const sha = (bytes) => createHash("sha256").update(bytes).digest("hex");

const results = [];
for (const { files, depth, fill = "auto", bake, budget, frames = [] } of jobs) {
  const voxrt = await Voxrt.load(module);
  try {
    const given = await Promise.all(files.map(async (path) => ({ name: basename(path), bytes: new Uint8Array(await readFile(path)) })));
    const read = await readFiles(given, voxrt);
    const built = read.memory ?? voxrt.voxelize(read.scene, { depth, fill, bake, budget });
    voxrt.setMemory(built.words, built.depth);
    const pictures = frames.map(({ camera, size, shading }) => {
      voxrt.shade({ materials: built.materials.map((material) => material.colour), mirrors: built.materials.flatMap(({ mirror }, id) => (mirror ? [id] : [])), ...shading });
      const whole = voxrt.render(camera, size);
      const half = Math.floor(voxrt.tileRows(size[1]) / 2);
      const parts = [voxrt.render(camera, size, 0, half), voxrt.render(camera, size, half)];
      const rgba = [voxrt.renderImage(camera, size, 0, half), voxrt.renderImage(camera, size, half, undefined, new ArrayBuffer(4 * size[0] * (size[1] - 16 * half)))];
      const opaque = Buffer.concat(rgba.map(({ pixels }) => new Uint8Array(pixels.buffer))).filter((byte, i) => (i % 4 < 3 ? true : byte !== 255));
      const joined = Buffer.concat(parts.map((part) => part.colour));
      return { colour: sha(whole.colour), material: sha(whole.material), face: sha(whole.face), wordsRead: whole.wordsRead, banded: joined.equals(whole.colour) && opaque.equals(joined) && rgba[1].top === 16 * half };
    });
    results.push({
      name: read.name, words: sha(Buffer.from(built.words.buffer, built.words.byteOffset, built.words.byteLength)), count: built.words.length, depth: built.depth,
      grid: built.grid, materials: built.materials, objects: built.objects, warnings: [...(read.scene?.warnings ?? []), ...built.warnings],
      voxels: voxrt.voxels(), baked: built.baked, fitted: built.fitted, pictures, bytes: voxrt.bytes,
    });
  } catch (error) {
    results.push({ problem: error.message });
  }
}
console.log(JSON.stringify(results));
