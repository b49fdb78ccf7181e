// Reads .mem files, and the manifest beside them.

import { readManifest } from "./manifest.js";
import { PLAIN } from "./memory.js";
import { BACKGROUND } from "./voxrt/voxrt.js";
/** @import { DroppedFile } from "./folder.js" @import { Memory } from "./memory.js" */

/** Read words, and what their manifest says. @param {DroppedFile} mem @param {DroppedFile | undefined} beside the
 * manifest */
export function readMem(mem, beside) {
  const { name, bytes } = mem;
  const text = new TextDecoder().decode(bytes).replace(/\/\*[\s\S]*?\*\/|\/\/[^\n]*/g, " ");
  const parts = text.split(/\s+/).filter(Boolean);
  const broken = parts.findIndex((part) => !/^[0-9A-Fa-f_]{1,16}$/.test(part));
  const shown = JSON.stringify(parts[broken]?.slice(0, 20));
  if (broken >= 0) throw new Error(`${name}: word ${broken} is ${shown}, which is not hexadecimal`);
  if (!parts.length) throw new Error(`${name}: has no words`);
  const words = Uint32Array.from(parts, (part) => Number.parseInt(part.replaceAll("_", ""), 16));
  const plain = { words, depth: null, materials: Array.from({ length: 256 }, tinted), objects: [], warnings: [] };
  if (!beside) return { ...plain, grid: null, manifest: null, lighting: null, view: null };
  const manifest = readManifest(beside, mem);
  if (manifest.words !== words.length)
    throw new Error(`${name}: has ${words.length} words, and its manifest says ${manifest.words}`);
  const { depth, materials, objects, world, lighting, view, animation } = manifest;
  const warnings = [...manifest.warnings];
  const still = `${name} has ${animation?.frames.length} frames, and the first is used`;
  if (animation && animation.frames.length > 1) warnings.push({ kind: "frames", message: still, count: 1 });
  const grid = world ? { origin: world.origin, voxelSize: world.voxel_size } : null;
  const own = { grid, lighting: lighting ? { ...PLAIN, ...lighting } : null, view: view ?? null };
  return { words, depth, materials, objects, warnings, manifest, ...own };
}

/** @param {unknown} _ @param {number} id */
const tinted = (_, id) => ({ name: id ? `material ${id}` : "empty", colour: tint(id), mirror: false, authored: false });

/** Distinct colours for ids without a table. @param {number} id */
function tint(id) {
  if (id === 0) return BACKGROUND;
  const hue = (id * 137.508) % 360;
  /** @param {number} shift */
  const channel = (shift) => Math.round(255 * (0.62 + 0.3 * Math.cos(((hue + shift) * Math.PI) / 180)));
  return [channel(0), channel(240), channel(120)];
}
