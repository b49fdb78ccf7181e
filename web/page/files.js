// Dropped files as a scene: three.js parses them. Nothing is fetched but the files themselves.

import { extension, FileError, Folder, stem } from "./folder.js";
/** @import { DroppedFile } from "./folder.js" @import { Memory } from "./memory.js" */
/** @import { Scene, Voxrt, Warning } from "./voxrt/voxrt.js" */

/** @typedef {Scene & { warnings: Warning[] }} ReadScene */
/** @typedef {{ name: string, file: string } & ({ scene: ReadScene, memory?: undefined } | { memory: Omit<Memory,
 * "name" | "file">, scene?: undefined })} ReadFile */
/** @typedef {(main: DroppedFile, folder: Folder, voxrt: Voxrt) => Promise<ReadScene>} Reader */
/** @type {() => Promise<Reader>} */ const usd = async () => (await import("./usd/read.js")).readUsd;
/** @type {() => Promise<Reader>} */ const gltf = async () => (await import("./read_gltf.js")).readGltf;

/** @type {Map<string, () => Promise<Reader>>} the readers of scenes, by the extension of the file */
const READERS = new Map([
  ["glb", gltf],
  ["gltf", gltf],
  ["obj", async () => (await import("./read_obj.js")).readObj],
  ["stl", async () => (await import("./read_geometry.js")).readStl],
  ["ply", async () => (await import("./read_geometry.js")).readPly],
  ["usdz", usd],
  ["usda", usd],
  ["usdc", usd],
  ["usd", usd],
]);
const FORMATS = [...READERS.keys(), "vox", "mem"];

/** The first scene that no other one names: layers of USD refer to each other. @param {DroppedFile[]} files */
function sceneAmong(files) {
  const scenes = files.filter(({ name }) => FORMATS.includes(extension(name)));
  const texts = scenes.map(({ name, bytes }) =>
    scenes.length > 1 && extension(name).startsWith("usd") ? new TextDecoder("latin1").decode(bytes) : "",
  );
  const isNamed = (/** @type {string} */ name) =>
    texts.some((text, i) => scenes[i].name !== name && text.includes(name));
  return scenes.find(({ name }) => !isNamed(name)) ?? scenes[0];
}

/** Read files, one of which is a scene or a memory. @param {DroppedFile[]} files @param {Voxrt} voxrt */
export async function readFiles(files, voxrt) {
  const main = sceneAmong(files);
  if (!main) {
    const formats = FORMATS.map((format) => `.${format}`).join(", ");
    throw new FileError(`${files[0]?.name ?? "nothing"}: is no scene; drop ${formats}`);
  }
  const known = { name: stem(main.name), file: main.name };
  const kind = extension(main.name);
  try {
    if (kind === "mem") {
      const { readMem } = await import("./read_mem.js");
      const manifest = files.find(({ name }) => name === `${known.name}.json`);
      const memory = readMem(main, manifest);
      return { ...known, memory: { ...memory, depth: memory.depth ?? voxrt.depthOf(memory.words) } };
    }
    if (kind === "vox") {
      const { readVox } = await import("./vox.js");
      return { ...known, memory: readVox(main.name, main.bytes, voxrt) };
    }
    if (!main.bytes.length) throw new FileError("is empty; export it again");
    const read = await (READERS.get(kind) ?? usd)();
    const scene = await read(main, new Folder(files), voxrt);
    if (!scene.objects.length) throw new FileError("has no triangles to voxelize; check that the scene shows a mesh");
    return { ...known, scene };
  } catch (error) {
    const text = error instanceof Error ? error.message : String(error);
    const isOurs = !(error instanceof RangeError || error instanceof TypeError || error instanceof SyntaxError);
    const problem = (isOurs ? "" : "is damaged or cut off; export it again: ") + text.split("\n")[0];
    throw new FileError(problem.startsWith(main.name) ? problem : `${main.name}: ${problem}`);
  }
}
