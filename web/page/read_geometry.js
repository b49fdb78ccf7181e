// STL and PLY files: one geometry each. PLYLoader rounds colours in linear light, so those of vertices are read as
// properties of our own.

import { stem } from "./folder.js";
import { decodeImage } from "./images.js";
import { PLYLoader } from "./three/addons/loaders/PLYLoader.js";
import { STLLoader } from "./three/addons/loaders/STLLoader.js";
import { Mesh } from "./three/three.core.js";
import { hintUpAxis } from "./up_axis.js";
import { sceneOf } from "./voxrt/scene.js";
import { Warnings } from "./voxrt/warnings.js";
/** @import { BufferGeometry } from "three" @import { PLYLoader as Loader } from "three/addons/loaders/PLYLoader.js" */
/** @import { Reader } from "./files.js" @import { DroppedFile, Folder } from "./folder.js" */
/** @import { Rules, Setter } from "./voxrt/scene.js" @import { Appearance, Voxrt } from "./voxrt/voxrt.js" */

/** @typedef {Record<string, string>} Properties their types by name */
const STORED = "stored_colour";
const BYTES = { char: 127, int8: 127, uchar: 255, uint8: 255 };
/** @type {Record<string, number>} */
const WHOLE = { ...BYTES, short: 32767, int16: 32767, ushort: 65535, uint16: 65535 };

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
  hintUpAxis(scene);
  return scene;
}

/** @param {Loader} loader */ function readsColours(loader) {
  loader.setCustomPropertyNameMapping({ [STORED]: ["red", "green", "blue"] });
  return loader;
}

/** The properties of each element, by name. @param {string} header */
function elementsOf(header) {
  /** @type {Record<string, Properties>} */ const elements = {};
  /** @type {Properties} */ let properties = {};
  for (const words of header.split("\n").map((line) => line.trim().split(/\s+/))) {
    if (words[0] === "element") {
      properties = {};
      elements[words[1]] = properties;
    }
    if (words[0] === "property") properties[words[words.length - 1]] = words[1];
  }
  return elements;
}

/** @param {Uint8Array} bytes @param {BufferGeometry} geometry @param {Folder} folder @param {Voxrt} voxrt */
async function plyLook(bytes, geometry, folder, voxrt) {
  const header = new TextDecoder("latin1").decode(bytes.subarray(0, 1 << 16)).split("end_header")[0];
  const names = [...header.matchAll(/^comment\s+TextureFile\s+(.+?)\s*$/gm)].map(([, name]) => name);
  const warnings = new Warnings();
  const look =
    (await textured(names, geometry, folder, warnings)) ?? coloured(elementsOf(header), geometry, voxrt, warnings);
  return { warnings: warnings.list(), rules: { appearanceOf: () => look } };
}

/** @param {string[]} names @param {BufferGeometry} geometry @param {Folder} folder @param {Warnings} warnings */
async function textured(names, geometry, folder, { warn }) {
  const uv = geometry.getAttribute("uv");
  if (names.length > 1) warn("texture", "several textures of one PLY file are not shown here; voxrt build shows them");
  else if (names.length && !uv)
    warn("texture", "the file names a texture and has no texture coordinates: the texture was not used");
  if (names.length !== 1 || !uv) return null;
  const file = folder.find(names[0]);
  if (!file) {
    warn("missing-texture", `texture '${names[0]}' was not found`);
    return null;
  }
  const image = await decodeImage(file.bytes, `texture ${names[0]}`);
  const clear = image.pixels.some((byte, i) => i % 4 === 3 && byte < 255);
  /** @type {Appearance} */ const entry = { name: "texture", texture: { image }, cutoff: clear ? 0.5 : 0 };
  /** @type {Setter} */ const uvOf = (vertex, out) => {
    out[0] = uv.getX(vertex);
    out[1] = 1 - uv.getY(vertex);
  };
  return { entry, uvOf };
}

/** @param {Record<string, Properties>} elements @param {BufferGeometry} geometry @param {Voxrt} voxrt @param
 * {Warnings} warnings */
function coloured({ vertex: ofVertices = {}, face: ofFaces = {} }, geometry, voxrt, { warn }) {
  const byFace = "red" in ofFaces;
  const properties = byFace ? ofFaces : ofVertices;
  const colour = geometry.getAttribute(byFace ? "color" : STORED);
  if (!colour || !("red" in properties)) return null;
  if ("alpha" in properties) warn("vertex-colours", "the opacity of colours is not used here; voxrt build uses it");
  if (byFace) warn("vertex-colours", "dark colours of faces are coarse here; voxrt build has them exactly");
  const whole = WHOLE[ofVertices.red] ?? (colour.array.some((part) => part > 1) ? 255 : 1);
  /** @param {number} part */ const stored = (part) => Math.round(Math.min(1, Math.max(0, (part || 0) / whole)) * 255);
  /** @param {number} part */ const linear = (part) => voxrt.linear(byFace ? voxrt.srgb(part) : stored(part));
  /** @type {Setter} */ const colourOf = (vertex, out) => {
    out[0] = linear(colour.getX(vertex));
    out[1] = linear(colour.getY(vertex));
    out[2] = linear(colour.getZ(vertex));
    out[3] = 1;
  };
  return { entry: { name: byFace ? "face colours" : "vertex colours" }, colourOf };
}
