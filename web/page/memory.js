// An octree memory as the page has it, and as the text of a .mem file.

import { FACES } from "./voxrt/voxrt.js";
import { hex } from "./voxrt/words.js";
/** @import { Box, Registers } from "./camera.js" @import { Manifest } from "./manifest.js" */
/** @import { Baked, Fitted, Material, Warning } from "./voxrt/voxrt.js" */

/** The lighting of a memory; the fields are those of manifests. `position`: in 1/16 voxel. @typedef {{ position:
 * number[], ambient: number, on: boolean, flat: boolean, bounces: number, faces: number[] | null }} Lighting */

/** @type {Lighting} the lighting of a memory that names no other */
export const PLAIN = { position: [0, 0, 0], ambient: 90, on: false, flat: false, bounces: 0, faces: FACES };
/** @type {Lighting} the lighting of a memory with baked light */ export const FLAT = { ...PLAIN, flat: true };

/** A memory that was built or read. `fixed`: it was read or edited, and cannot be built otherwise. `view`: the camera of its
 * author; `manifest`: that it came with; `lossless`: what fits a budget that gives up much. @typedef {{ name: string, file: string, words: Uint32Array, depth: number,
 * materials: Required<Material>[], grid: { origin: readonly number[], voxelSize: number } | null, objects:
 * object[], warnings: Warning[], lighting?: Lighting | null, view?: Registers | null, manifest?: Manifest | null,
 * baked?: Baked | null, fitted?: Fitted | null, lossless?: { depth: number, words: number } | null, fill?: string, rule?: string, up?: string |
 * null, unit?: number | null, seconds?: number, fixed?: boolean, edited?: boolean }} Memory */

/** @typedef {Memory & { voxels: number[], bounds: Box }} Shown with voxels by material */

/** The text of a .mem file: one word per line. @param {Uint32Array} words */
export function memBytes(words) {
  const encoder = new TextEncoder();
  const bytes = new Uint8Array(9 * words.length);
  words.forEach((word, i) => {
    encoder.encodeInto(`${hex(word)}\n`, bytes.subarray(9 * i));
  });
  return bytes;
}

/** The box of cubes: x, y, z of the lowest corner and the side, each; null for none. @param {Int32Array} cubes
 * @returns {Box | null} */
export function boundsOf(cubes) {
  if (!cubes.length) return null;
  const [low, high] = [Array(3).fill(Infinity), Array(3).fill(-Infinity)];
  for (let i = 0; i < cubes.length; i += 4)
    for (let axis = 0; axis < 3; axis++) {
      low[axis] = Math.min(low[axis], cubes[i + axis]);
      high[axis] = Math.max(high[axis], cubes[i + axis] + cubes[i + 3]);
    }
  return [low, high];
}

/** The whole world. @param {number} depth @returns {Box} */
export const worldOf = (depth) => [Array(3).fill(0), Array(3).fill(2 ** depth)];
