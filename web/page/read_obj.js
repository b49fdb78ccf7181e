// OBJ files with their MTL files.

import { stem } from "./folder.js";
import { code, objLooks } from "./obj_looks.js";
import { withoutConcave } from "./polygons.js";
import { MTLLoader } from "./three/addons/loaders/MTLLoader.js";
import { OBJLoader } from "./three/addons/loaders/OBJLoader.js";
import { sceneOf } from "./voxrt/scene.js";
/** @import { Reader } from "./files.js" @import { MaterialInfo } from "three/addons/loaders/MTLLoader.js" */

/** @type {Map<number, string>} encodings by their mark */ const MARKS = new Map([
  [0xfeff, "utf-16be"],
  [0xfffe, "utf-16le"],
]);

/** Text of UTF-16 with its mark, else of UTF-8, else of Windows-1252. @param {Uint8Array} bytes */
function textOf(bytes) {
  const mark = MARKS.get(256 * bytes[0] + bytes[1]);
  try {
    return new TextDecoder(mark ?? "utf-8", { fatal: !mark }).decode(bytes);
  } catch {
    return new TextDecoder("windows-1252").decode(bytes);
  }
}

/** @type {Reader} */ export async function readObj(main, folder, voxrt) {
  const text = textOf(main.bytes);
  /** @type {Map<string, MaterialInfo>} */ const library = new Map();
  for (const [, name] of text.matchAll(/^\s*mtllib\s+(.+?)\s*$/gm)) {
    const file = folder.find(name);
    if (!file) continue;
    const { materialsInfo } = new MTLLoader().parse(textOf(file.bytes), "");
    for (const [key, info] of Object.entries(materialsInfo)) if (!library.has(key)) library.set(key, info);
  }
  const root = new OBJLoader().parse(withoutConcave(text));
  const looks = await objLooks(library, folder, voxrt);
  const scene = sceneOf(root, voxrt, {
    nameOf: (mesh) => mesh.name || stem(main.name),
    materialOf: ({ name }) => {
      const { kd } = library.get(name) ?? {};
      if (!name || (!kd && !text.includes("usemtl"))) return null;
      return { key: name, name, colour: kd ? kd.map(code) : [200, 200, 200] };
    },
    ...(/^\s*vn\s/m.test(text) ? {} : { normalsOf: () => null }), // OBJLoader makes some of its own
    ...looks.rules,
  });
  scene.warnings.push(...looks.warnings);
  return scene;
}
