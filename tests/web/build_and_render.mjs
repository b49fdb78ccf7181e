// What the page does with dropped files, in Node. A job: {files, depth, fill, bake, budget, frames: [{camera, size, shading}]}
import { readFile } from "node:fs/promises";
import { basename } from "node:path";
import { answer, fileOf, importOf, sha } from "./jobs.mjs";

globalThis.self = globalThis;
globalThis.ProgressEvent ??= class extends Event {};

const { Voxrt } = await importOf("voxrt/voxrt.js");
const { readFiles } = await importOf("files.js");
const { extension } = await importOf("folder.js");
const { placed } = await importOf("placing.js");
const module = await WebAssembly.compile(await fileOf("voxrt/voxrt.wasm"));

await answer(async ({ files, depth, fill = "auto", rule = "touch", bake, budget, frames = [] }) => {
  const voxrt = await Voxrt.load(module);
  const given = await Promise.all(files.map(async (path) => ({ name: basename(path), bytes: new Uint8Array(await readFile(path)) })));
  const read = await readFiles(given, voxrt);
  const built = read.memory ?? voxrt.voxelize(placed(read.scene, extension(read.file), { up: null, unit: null }), { depth, fill, rule, bake, budget });
  voxrt.setMemory(built.words, built.depth);
  const pictures = frames.map(({ camera, size, shading }) => {
    voxrt.shade({ materials: built.materials.map((material) => material.colour), mirrors: built.materials.flatMap(({ mirror }, id) => (mirror ? [id] : [])), ...shading });
    const whole = voxrt.render(camera, size);
    const half = Math.floor(voxrt.tileRows(size[1]) / 2);
    const parts = [voxrt.render(camera, size, 0, half), voxrt.render(camera, size, half)];
    const rgba = [voxrt.renderImage(camera, size, 0, half), voxrt.renderImage(camera, size, half, undefined, new ArrayBuffer(4 * size[0] * (size[1] - 16 * half)))];
    const opaque = Buffer.concat(rgba.map(({ pixels }) => new Uint8Array(pixels.buffer))).filter((byte, i) => (i % 4 < 3 ? true : byte !== 255));
    const joined = Buffer.concat(parts.map((part) => part.colour));
    return { colour: sha(whole.colour), material: sha(whole.material), face: sha(whole.face), banded: joined.equals(whole.colour) && opaque.equals(joined) && rgba[1].top === 16 * half };
  });
  const { words, grid, materials, objects, baked, fitted } = built;
  const warnings = [...(read.scene?.warnings ?? []), ...built.warnings];
  return { name: read.name, words: sha(words), count: words.length, depth: built.depth, grid, materials, objects, warnings, baked, fitted, pictures };
});
