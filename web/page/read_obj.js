// OBJ files with their MTL files. Triangles show map_Kd of the material, else the colours of their vertices.

import { stem } from "./folder.js";
import { decodeImage } from "./images.js";
import { withoutConcave } from "./polygons.js";
import { MTLLoader } from "./three/addons/loaders/MTLLoader.js";
import { OBJLoader } from "./three/addons/loaders/OBJLoader.js";
import { hintUpAxis } from "./up_axis.js";
import { leftOut, OPAQUE_FROM } from "./voxrt/opacity.js";
import { colours, sceneOf } from "./voxrt/scene.js";
import { Warnings } from "./voxrt/warnings.js";
/** @import { MaterialInfo } from "three/addons/loaders/MTLLoader.js" @import { Reader } from "./files.js" */
/** @import { Folder } from "./folder.js" @import { Attribute, Rules, Setter } from "./voxrt/scene.js" */
/** @import { Appearance, Voxrt, Warning } from "./voxrt/voxrt.js" */

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

/** Without groups where the file has objects: OBJLoader takes both for objects. @param {string} text */
const objectsOf = (text) => (/^\s*o\s/m.test(text) ? text.replace(/^\s*g\b.*$/gm, "") : text);

/** @type {Reader} */ export async function readObj(main, folder, voxrt) {
  const text = objectsOf(textOf(main.bytes));
  const warnings = new Warnings();
  /** @type {Map<string, MaterialInfo>} */ const library = new Map();
  for (const [, name] of text.matchAll(/^\s*mtllib\s+(.+?)\s*$/gm)) {
    const file = folder.find(name);
    if (!file) {
      warnings.warn("missing-library", `material library '${name}' was not found`);
      continue;
    }
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
  scene.warnings.push(...warnings.list(), ...looks.warnings);
  hintUpAxis(scene);
  return scene;
}

/** @typedef {{ file: string, scale: number[], offset: number[], clamp: boolean }} Placed an image */
/** @type {Record<string, number>} */
const VALUES = { "-s": 3, "-o": 3, "-t": 3, "-mm": 2 }; // the most numbers of an option; others have one word

/** @param {Map<string, MaterialInfo>} library by name @param {Folder} folder @param {Voxrt} voxrt @returns
 * {Promise<{ warnings: Warning[], rules: Partial<Rules> }>} */
async function objLooks(library, folder, voxrt) {
  /** @type {Warning[]} */ const warnings = [];
  /** @type {Map<string, Appearance>} */ const entries = new Map();
  /** @type {Map<string, Placed>} */ const textures = new Map();
  for (const [name, { map_kd: map, map_d: opacity }] of library) {
    if (opacity)
      warnings.push({ kind: "texture", message: `map_d of ${name} is not used here; voxrt build uses it`, count: 1 });
    if (!map) continue;
    const placed = placement(map);
    const file = folder.find(placed.file);
    if (!file) {
      const message = `texture '${placed.file}' was not found; its material's own value was used`;
      warnings.push({ kind: "missing-texture", message, count: 1 });
      continue;
    }
    const image = await decodeImage(file.bytes, `map_Kd ${placed.file}`);
    const wrap = placed.clamp ? "clamp" : "repeat";
    textures.set(name, placed);
    entries.set(`${name} textured`, { name, texture: { image, wrap: [wrap, wrap] } });
  }
  /** @param {string} name */ const coloured = (name) => {
    const key = `${name} coloured`;
    const kd = library.get(name)?.kd?.map((part) => voxrt.linear(code(part)));
    const entry = entries.get(key) ?? { name: name || "vertex colours", factor: [...(kd ?? [1, 1, 1]), 1] };
    entries.set(key, entry);
    return entry;
  };
  return {
    warnings,
    rules: {
      leavesOut: ({ name }) => leftOut(opacityOf(library.get(name)), OPAQUE_FROM),
      appearanceOf({ name }, geometry) {
        if (opacityOf(library.get(name)) < OPAQUE_FROM) return null;
        const [placed, textured] = [textures.get(name), entries.get(`${name} textured`)];
        const uv = geometry.getAttribute("uv");
        if (placed && textured && uv) return { entry: textured, uvOf: uvSetter(uv, placed) };
        const colour = geometry.getAttribute("color");
        if (!colour) return null;
        const set = colours(colour);
        return {
          entry: coloured(name),
          covers: (vertex) =>
            [colour.getX(vertex), colour.getY(vertex), colour.getZ(vertex)].some((part) => part !== 1),
          colourOf(vertex, out) {
            set(vertex, out);
            for (let channel = 0; channel < 3; channel++) out[channel] = voxrt.linear(voxrt.srgb(out[channel]));
            out[3] = 1;
          },
        };
      },
    },
  };
}

/** @param {Attribute} uv @param {Placed} placed @returns {Setter} */ const uvSetter =
  (uv, { scale, offset }) =>
  (vertex, out) => {
    out[0] = uv.getX(vertex) * scale[0] + offset[0];
    out[1] = 1 - (uv.getY(vertex) * scale[1] + offset[1]);
  };

/** A part of a colour, 0 … 1, as 0 … 255; halves become even. @param {number} part */
function code(part) {
  const value = 255 * Math.min(1, Math.max(0, part));
  return value % 1 === 0.5 ? 2 * Math.round(value / 2) : Math.round(value);
}

/** @param {MaterialInfo | undefined} material */
const opacityOf = (material) => Number(material?.d ?? (material?.tr === undefined ? 1 : 1 - material.tr));

/** The arguments of map_Kd: options, then the name of a file, which may have blanks. @param {string} text */
function placement(text) {
  const words = text.trim().split(/\s+/);
  const placed = { scale: [1, 1], offset: [0, 0], clamp: false };
  let at = 0;
  while (at < words.length - 1 && words[at].startsWith("-")) {
    const option = words[at++].toLowerCase();
    /** @type {string[]} */ const values = [];
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
