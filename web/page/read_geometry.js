// STL and PLY files: one geometry each.

import { stem } from "./folder.js";
import { plyLook, readsColours } from "./ply_look.js";
import { PLYLoader } from "./three/addons/loaders/PLYLoader.js";
import { STLLoader } from "./three/addons/loaders/STLLoader.js";
import { Mesh } from "./three/three.core.js";
import { sceneOf } from "./voxrt/scene.js";
/** @import { BufferGeometry } from "three" @import { Reader } from "./files.js" */
/** @import { DroppedFile } from "./folder.js" @import { Rules } from "./voxrt/scene.js" */
/** @import { Voxrt } from "./voxrt/voxrt.js" */

/** @param {BufferGeometry} geometry @param {DroppedFile} main @param {Voxrt} voxrt @param {Partial<Rules>} rules */
function bare(geometry, main, voxrt, rules) {
  const mesh = new Mesh(geometry);
  mesh.name = stem(main.name);
  return sceneOf(mesh, voxrt, { materialOf: () => null, ...rules });
}

/** @type {Reader} */ export async function readStl(main, _folder, voxrt) {
  const rules = { appearanceOf: () => null, normalsOf: () => null }; // its normals are those of the faces
  return bare(new STLLoader().parse(main.bytes.buffer), main, voxrt, rules);
}

/** Where only the last line of a header ends with "\r\n", PLYLoader would start with the data a byte early. @param
 * {Uint8Array<ArrayBuffer>} bytes */
function withoutReturn(bytes) {
  const header = new TextDecoder("latin1").decode(bytes.subarray(0, 1 << 16));
  const at = header.indexOf("end_header\r\n") + "end_header".length;
  if (!header.startsWith("ply\n") || header[at] !== "\r") return bytes;
  const made = new Uint8Array(bytes.length - 1);
  made.set(bytes.subarray(0, at));
  made.set(bytes.subarray(at + 1), at);
  return made;
}

/** @type {Reader} */ export async function readPly(main, folder, voxrt) {
  const geometry = readsColours(new PLYLoader()).parse(withoutReturn(main.bytes).buffer);
  const { rules, warnings } = await plyLook(main.bytes, geometry, folder, voxrt);
  const scene = bare(geometry, main, voxrt, rules);
  scene.warnings.push(...warnings);
  return scene;
}
