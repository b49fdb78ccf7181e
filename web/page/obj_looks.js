// Textures and vertex colours of OBJ files: map_Kd of the material, else its vertices' colours.

import { decodeImage } from "./images.js";

const OPAQUE_FROM = 0.5;
const VALUES = { "-s": 3, "-o": 3, "-t": 3, "-mm": 2 }; // the most numbers of an option; others have one word

// `library`: MTLLoader's materials by name. Returns rules for sceneOf, and warnings.
export async function objLooks(library, folder, voxrt) {
  const warnings = [];
  const entries = new Map();
  const textures = new Map();
  for (const [name, { kd, map_kd: map, map_d: opacity }] of library) {
    if (opacity)
      warnings.push({ kind: "texture", message: `map_d of ${name} is not used here; voxrt build uses it`, count: 1 });
    if (!map) continue;
    const placed = placement(map);
    const file = folder.find(placed.file);
    if (!file) {
      warnings.push({
        kind: "missing-texture",
        message: `texture '${placed.file}' was not found; its material's own value was used`,
        count: 1,
      });
      continue;
    }
    const image = await decodeImage(file.bytes, `map_Kd ${placed.file}`);
    const wrap = placed.clamp ? "clamp" : "repeat";
    textures.set(name, placed);
    entries.set(`${name} textured`, { name, texture: { image, wrap: [wrap, wrap] } });
  }
  const coloured = (name) => {
    const key = `${name} coloured`;
    const kd = library.get(name)?.kd?.map((part) => voxrt.linear(code(part)));
    if (!entries.has(key)) entries.set(key, { name: name || "vertex colours", factor: [...(kd ?? [1, 1, 1]), 1] });
    return entries.get(key);
  };
  return {
    warnings,
    rules: {
      isLeftOut: ({ name }) => isClear(library.get(name)),
      appearanceOf({ name }, geometry) {
        if (isClear(library.get(name))) return null;
        const placed = textures.get(name);
        const uv = geometry.getAttribute("uv");
        if (placed && uv) {
          const uvOf = (vertex, out) => {
            out[0] = uv.getX(vertex) * placed.scale[0] + placed.offset[0];
            out[1] = 1 - (uv.getY(vertex) * placed.scale[1] + placed.offset[1]);
          };
          return { entry: entries.get(`${name} textured`), uvOf };
        }
        const colour = geometry.getAttribute("color");
        if (!colour) return null;
        const stored = (part) => voxrt.linear(voxrt.srgb(part));
        return {
          entry: coloured(name),
          covers: (vertex) =>
            [colour.getX(vertex), colour.getY(vertex), colour.getZ(vertex)].some((part) => part !== 1),
          colourOf(vertex, out) {
            [out[0], out[1], out[2], out[3]] = [
              stored(colour.getX(vertex)),
              stored(colour.getY(vertex)),
              stored(colour.getZ(vertex)),
              1,
            ];
          },
        };
      },
    },
  };
}

// A part of a colour, 0 … 1, as 0 … 255; halves become even.
export function code(part) {
  const value = 255 * Math.min(1, Math.max(0, part));
  return value % 1 === 0.5 ? 2 * Math.round(value / 2) : Math.round(value);
}

const isClear = (material) => Number(material?.d ?? (material?.tr === undefined ? 1 : 1 - material.tr)) < OPAQUE_FROM;

// The arguments of map_Kd: options, then the name of a file, which may have blanks.
function placement(text) {
  const words = text.trim().split(/\s+/);
  const placed = { scale: [1, 1], offset: [0, 0], clamp: false };
  let at = 0;
  while (at < words.length - 1 && words[at].startsWith("-")) {
    const option = words[at++].toLowerCase();
    const values = [];
    for (
      let most = VALUES[option] ?? 1;
      values.length < most && at < words.length - 1 && (!(option in VALUES) || Number.isFinite(Number(words[at])));
    )
      values.push(words[at++]);
    if (option === "-s") placed.scale = [Number(values[0]), Number(values[1] ?? 1)];
    if (option === "-o") placed.offset = [Number(values[0]), Number(values[1] ?? 0)];
    if (option === "-clamp") placed.clamp = values[0] === "on";
  }
  return { ...placed, file: words.slice(at).join(" ") };
}
