// The texture or the colours of a PLY file. PLYLoader rounds colours in linear light, so those of vertices are read as
// properties of our own.

import { decodeImage } from "./images.js";

const STORED = "stored_colour";
const WHOLE = {
  char: 127,
  int8: 127,
  uchar: 255,
  uint8: 255,
  short: 32767,
  int16: 32767,
  ushort: 65535,
  uint16: 65535,
};

export function readsColours(loader) {
  loader.setCustomPropertyNameMapping({ [STORED]: ["red", "green", "blue"] });
  return loader;
}

// The types of the properties of each element, by name.
function elementsOf(header) {
  const elements = {};
  let properties = {};
  for (const words of header.split("\n").map((line) => line.trim().split(/\s+/))) {
    if (words[0] === "element") elements[words[1]] = properties = {};
    if (words[0] === "property") properties[words.at(-1)] = words[1];
  }
  return elements;
}

// `geometry`: of a PLYLoader that readsColours(). Returns rules for sceneOf, and warnings.
export async function plyLook(bytes, geometry, folder, voxrt) {
  const header = new TextDecoder("latin1").decode(bytes.subarray(0, 1 << 16)).split("end_header")[0];
  const names = [...header.matchAll(/^comment\s+TextureFile\s+(.+?)\s*$/gm)].map(([, name]) => name);
  const { vertex: ofVertices = {}, face: ofFaces = {} } = elementsOf(header);
  const warnings = [];
  const warn = (kind, message) => warnings.push({ kind, message, count: 1 });
  const uv = geometry.getAttribute("uv");
  let entry = null;
  if (names.length > 1) warn("texture", "several textures of one PLY file are not shown here; voxrt build shows them");
  else if (names.length && !uv)
    warn("texture", "the file names a texture and has no texture coordinates: the texture was not used");
  else if (names.length) {
    const file = folder.find(names[0]);
    if (file) {
      const image = await decodeImage(file.bytes, `texture ${names[0]}`);
      const clear = image.pixels.some((byte, i) => i % 4 === 3 && byte < 255);
      entry = { name: "texture", texture: { image }, cutoff: clear ? 0.5 : 0 };
    } else warn("missing-texture", `texture '${names[0]}' was not found`);
  }
  if (entry)
    return {
      warnings,
      rules: {
        appearanceOf: () => ({
          entry,
          uvOf: (vertex, out) => {
            out[0] = uv.getX(vertex);
            out[1] = 1 - uv.getY(vertex);
          },
        }),
      },
    };
  const byFace = "red" in ofFaces;
  const colour = geometry.getAttribute(byFace ? "color" : STORED);
  if (!colour || !("red" in (byFace ? ofFaces : ofVertices))) return { warnings, rules: { appearanceOf: () => null } };
  if ("alpha" in (byFace ? ofFaces : ofVertices))
    warn("vertex-colours", "the opacity of colours is not used here; voxrt build uses it");
  if (byFace) warn("vertex-colours", "dark colours of faces are coarse here; voxrt build has them exactly");
  const painted = { name: byFace ? "face colours" : "vertex colours" };
  const whole = WHOLE[ofVertices.red] ?? (colour.array.some((part) => part > 1) ? 255 : 1);
  const code = byFace
    ? (part) => voxrt.srgb(part)
    : (part) => Math.round(Math.min(1, Math.max(0, (part || 0) / whole)) * 255);
  const colourOf = (vertex, out) => {
    [out[0], out[1], out[2], out[3]] = [
      ...[colour.getX(vertex), colour.getY(vertex), colour.getZ(vertex)].map((part) => voxrt.linear(code(part))),
      1,
    ];
  };
  return { warnings, rules: { appearanceOf: () => ({ entry: painted, colourOf }) } };
}
