// Whether boxes meet solid voxels of an octree memory: what walking asks many times per picture.

import { isLeaf, material } from "./voxrt/words.js";
/** @import { Vector } from "./vectors.js" */

/** `root`: the word of the root. @typedef {{ words: Uint32Array, depth: number, root: number }} Octree */

/** Whether a box of any size, in voxels, overlaps a solid voxel; touching is no overlap. @param {Octree} octree @param
 * {Vector} low @param {Vector} high */
export function meetsSolid({ words, depth, root }, low, high) {
  /** @param {number} word @param {number} x @param {number} y @param {number} z @param {number} side @returns {boolean} */
  const meets = (word, x, y, z, side) => {
    if (x >= high[0] || y >= high[1] || z >= high[2]) return false;
    if (x + side <= low[0] || y + side <= low[1] || z + side <= low[2]) return false;
    if (isLeaf(word)) return material(word) !== 0;
    const half = side / 2;
    for (let octant = 0; octant < 8; octant++) {
      const corner = [x + (octant & 1) * half, y + ((octant >> 1) & 1) * half, z + (octant >> 2) * half];
      if (meets(words[word + octant], corner[0], corner[1], corner[2], half)) return true;
    }
    return false;
  };
  return meets(root, 0, 0, 0, 2 ** depth);
}
