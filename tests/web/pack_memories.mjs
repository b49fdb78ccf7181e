// A memory packed for a link and unpacked again, in Node. A job: {files, depth, bake}
import { readFile } from "node:fs/promises";
import { basename } from "node:path";
import { deflateSync } from "node:zlib";
import { answer, fileOf, importOf, sha } from "./jobs.mjs";

globalThis.self = globalThis;
globalThis.ProgressEvent ??= class extends Event {};

const { Voxrt } = await importOf("voxrt/voxrt.js");
const { readFiles } = await importOf("files.js");
const { manifestOf } = await importOf("downloads.js");
const { FLAT, memBytes } = await importOf("memory.js");
const { pack, unpack } = await importOf("packed.js");
const module = await WebAssembly.compile(await fileOf("voxrt/voxrt.wasm"));

await answer(async ({ files, depth, bake = null }) => {
  const voxrt = await Voxrt.load(module);
  const dropped = await Promise.all(files.map(async (path) => ({ name: basename(path), bytes: new Uint8Array(await readFile(path)) })));
  const read = await readFiles(dropped, voxrt);
  const built = read.memory ?? { ...voxrt.voxelize(read.scene, { depth, bake }), lighting: bake ? FLAT : null };
  voxrt.setMemory(built.words, built.depth);
  const shown = { ...built, name: read.name, file: read.file, voxels: voxrt.voxels() };
  const text = await pack(manifestOf(shown), built.words);
  const { memory, name } = await readFiles(await unpack(text), voxrt);
  const damaged = await Promise.all(
    [text.slice(0, -9), text.slice(9), `${text.slice(0, 50)}A${text.slice(51)}`, `${text}$`, ""].map((one) => unpack(one).then(() => null, ({ message }) => message)),
  );
  const bomb = Buffer.from(deflateSync(new Uint8Array(2 ** 24))).toString("base64url");
  const refused = await unpack(bomb, 2 ** 20).then(() => null, ({ message }) => message);
  const { materials, lighting, grid, view } = memory;
  return { name, length: text.length, mem: sha(memBytes(memory.words)), depth: memory.depth, materials, lighting, grid, view, damaged, refused };
});
