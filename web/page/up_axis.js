// Whether a mesh of a format that does not state its up axis stands on a flat base if z is up, but not if y is. The rule
// is that of hint_up_axis in voxelize/formats/scene_frame.py.

import { cross, length, subtract } from "./vectors.js";
/** @import { ReadScene } from "./files.js" @import { Vector } from "./vectors.js" */

const FLAT_SHARE = 0.02; // of the area, that is a base
const MUCH_MORE = 4; // than the other ends have
const THIN = 1e-4; // of the size
const ENOUGH = 200_000; // triangles that tell
const HINT = "the file does not state its up axis, and stands on a flat base if z is up: try --up z";

/** @param {ReadScene} scene whose objects are not turned */ export function hintUpAxis(scene) {
  if (standsOnZ(scene)) scene.warnings.push({ kind: "up-axis", message: HINT, count: 1 });
}

/** @param {ReadScene} scene */ function standsOnZ({ meshes }) {
  const step = Math.max(1, Math.floor(meshes.reduce((sum, mesh) => sum + mesh.triangles.length / 3, 0) / ENOUGH));
  const triangles = meshes.flatMap(({ positions, triangles: rows }) => {
    /** @param {number} row @returns {Vector} */
    const place = (row) => [positions[3 * row], positions[3 * row + 1], positions[3 * row + 2]];
    const count = Math.ceil(rows.length / 3 / step);
    return Array.from({ length: count }, (_, i) => [0, 1, 2].map((corner) => place(rows[3 * step * i + corner])));
  });
  const [low, high] = [Array(3).fill(Infinity), Array(3).fill(-Infinity)];
  for (const triangle of triangles)
    for (const corner of triangle)
      corner.forEach((part, axis) => {
        low[axis] = Math.min(low[axis], part);
        high[axis] = Math.max(high[axis], part);
      });
  const size = Math.max(...subtract(high, low));
  const areas = triangles.map(([a, b, c]) => length(cross(subtract(b, a), subtract(c, a))));
  const total = areas.reduce((sum, area) => sum + area, 0);
  /** @param {number} axis @param {number[]} end */ const share = (axis, end) => {
    const isFlat = (/** @type {Vector[]} */ triangle) =>
      triangle.every((corner) => Math.abs(corner[axis] - end[axis]) < THIN * size);
    return areas.reduce((sum, area, i) => sum + (isFlat(triangles[i]) ? area : 0), 0) / total;
  };
  if (!(total > 0)) return false;
  const base = share(2, low);
  return base >= FLAT_SHARE && base > MUCH_MORE * Math.max(share(2, high), share(1, low));
}
