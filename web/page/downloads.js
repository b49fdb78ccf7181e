// What the page hands out: the memory as .mem, its manifest, a link to the scene and the view.

import { crc32 } from "./crc32.js";
import { memBytes } from "./memory.js";
import { DIALECT, hex } from "./voxrt/words.js";
/** @import { Pose } from "./camera.js" @import { Shown } from "./memory.js" */
/** @import { Daylight } from "./voxrt/voxrt.js" */

/** The manifest as voxrt build writes it (export/manifest.py), or that of the memory. @param {Shown} memory */
export function manifestOf(memory) {
  const { name, file, words, depth, materials, grid, objects, warnings } = memory;
  const { seconds, fill, lighting, baked, voxels } = memory;
  const crc = hex(crc32(memBytes(words)));
  if (memory.manifest) return { ...memory.manifest, crc32: crc };
  const { wordsBefore: _before, words: _words, ...light } = baked ?? {};
  return {
    schema: 1,
    name,
    words: words.length,
    blocks: (words.length - 1) / 8,
    depth,
    dialect: DIALECT,
    crc32: crc,
    voxels: voxels.reduce((sum, count, id) => (id ? sum + count : 0), 0),
    materials: materials.map((material, id) => ({ id, ...material, voxels: voxels[id] })),
    world: grid && { origin: grid.origin, voxel_size: grid.voxelSize, matrix: matrixOf(grid) },
    objects: objects.map((object) => ({ source: "mesh", moved: [0, 0, 0], grown: [0, 0, 0], ...object })),
    warnings,
    seconds: { build: seconds ?? 0 },
    source: { file, settings: { fill: fill ?? null } },
    view: null,
    lighting: lighting ?? null,
    animation: null,
    baked: baked ? { ...light, words_before: baked.wordsBefore, words: baked.words } : null,
  };
}

/** From voxels to the scene. @param {NonNullable<Shown["grid"]>} grid */
const matrixOf = ({ origin, voxelSize }) =>
  [...origin, 1].map((place, row) => [0, 1, 2].map((at) => (at === row ? voxelSize : 0)).concat(place));

const NUMBERS = /^-?\d+(\.\d+)?$/;

/** The part of an address that carries a scene and its view. @param {{ example: string | null, depth: number, bake:
 * Daylight | null, words: number | null, view: Pose }} link */
export function linkOf({ example, depth, bake, words, view }) {
  const { eye, yaw, pitch, fov, distance } = view;
  const camera = [...eye, yaw, pitch, fov, distance].map((value) => Number(value.toFixed(3))).join(",");
  return `#${new URLSearchParams({
    ...(example ? { scene: example } : {}),
    depth: String(depth),
    ...(bake ? { bake: [...bake.sun, bake.sky[0], bake.samples].join(",") } : {}),
    ...(words ? { words: String(words) } : {}),
    camera,
  })}`;
}

/** What such a part of an address says; null for what it does not. @param {string} hash */
export function readLink(hash) {
  const fields = new URLSearchParams(hash.slice(1));
  /** @param {string} name @param {number} count */ const read = (name, count) => {
    const parts = (fields.get(name) ?? "").split(",");
    return parts.length === count && parts.every((part) => NUMBERS.test(part)) ? parts.map(Number) : null;
  };
  const words = Number(fields.get("words"));
  const depth = Number(fields.get("depth"));
  const [x, y, z, level = -1, samples = 0] = read("bake", 5) ?? [];
  const isBaked = level >= 0 && level <= 16 && Number.isInteger(samples) && samples >= 1 && samples <= 4096;
  const [eyeX, eyeY, eyeZ, yaw, pitch, fov, distance] = read("camera", 7) ?? [];
  return {
    example: fields.get("scene"),
    depth: Number.isInteger(depth) && depth >= 1 && depth <= 12 ? depth : null,
    bake: isBaked ? { sun: [x, y, z], sky: [level, level, level], samples } : null,
    words: Number.isInteger(words) && words >= 1 && words < 2 ** 32 ? words : null,
    camera: distance !== undefined ? { eye: [eyeX, eyeY, eyeZ], yaw, pitch, fov, distance } : null,
  };
}
