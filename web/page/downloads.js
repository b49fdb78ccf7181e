// The manifest of the memory that is shown.

import { crc32 } from "./crc32.js";
import { memBytes } from "./memory.js";
import { DIALECT, hex } from "./voxrt/words.js";
/** @import { Shown } from "./memory.js" */

/** The manifest as voxrt build writes it (export/manifest.py), or that of the memory. @param {Shown} memory */
export function manifestOf(memory) {
  const { name, file, words, depth, materials, grid, objects, warnings } = memory;
  const { seconds, fill, rule, up, unit, lighting, baked, voxels, view, edited } = memory;
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
    source: edited
      ? null
      : { file, settings: { fill: fill ?? null, rule: rule ?? null, up: up ?? null, unit: unit ?? null } },
    view: view ?? null,
    lighting: lighting ?? null,
    animation: null,
    baked: baked ? { ...light, words_before: baked.wordsBefore, words: baked.words } : null,
  };
}

/** From voxels to the scene. @param {NonNullable<Shown["grid"]>} grid */
const matrixOf = ({ origin, voxelSize }) =>
  [...origin, 1].map((place, row) => [0, 1, 2].map((at) => (at === row ? voxelSize : 0)).concat(place));
