// Where places of the grid are in a picture, and the cameras of parts of a picture.

import { add, cross, dot, length, scale, subtract } from "./vectors.js";
/** @import { Box, Registers, Size } from "./camera.js" @import { Vector } from "./vectors.js" */

const NEAR = 1 / 16; // voxels before the eye: what is nearer is beside the picture, or the eye is in it

/** The corners that each edge of a box joins. */
export const BOX_EDGES = ["01", "23", "45", "67", "02", "13", "46", "57", "04", "15", "26", "37"].map((edge) =>
  [...edge].map(Number),
);

/** `x`, `y`: in pixels, from the corner of the picture; `far`: voxels before the eye. @typedef {{ x: number, y: number,
 * far: number }} Seen */

/** A rectangle of pixels: column and row of its first one, columns and rows. @typedef {{ at: Size, size: Size }} Part */

/** What projects places, in voxels, to a picture. @param {Registers} registers @param {Size} size */
export function projection({ position, look, right, up }, [width, height]) {
  // away = t * (look + a * right + b * up), by Cramer's rule
  const eye = position.map((value) => value / 16);
  const normals = [cross(right, up), cross(up, look), cross(look, right)];
  const volume = dot(look, normals[0]);
  /** @param {Vector} place @returns {Seen} */ return (place) => {
    const away = subtract(place, eye);
    const [t, a, b] = normals.map((normal) => dot(away, normal) / volume);
    return { x: Math.floor(width / 2) + a / t + 0.5, y: Math.floor(height / 2) - b / t + 0.5, far: t * length(look) };
  };
}

/** @param {Box} box lowest and highest corner */ export const cornersOf = ([low, high]) =>
  Array.from({ length: 8 }, (_, i) => [0, 1, 2].map((axis) => ((i >> axis) & 1 ? high : low)[axis]));

/** The pixels of a picture whose rays may meet a box; null for none. Columns and rows are multiples of `step`. @param
 * {Box} box @param {Registers} registers @param {Size} size @param {number} step @returns {Part | null} */
export function partOf(box, registers, size, step) {
  const [low, high] = box;
  const eye = registers.position.map((value) => value / 16);
  if (eye.every((place, axis) => place > low[axis] - 1 && place < high[axis] + 1)) return { at: [0, 0], size };
  const project = projection(registers, size);
  const corners = cornersOf(box);
  const fars = corners.map((corner) => project(corner).far);
  // Behind the eye, an edge ends where it comes near.
  const ends = BOX_EDGES.flatMap(([a, b]) => {
    if (fars[a] < NEAR === fars[b] < NEAR) return [];
    const along = (NEAR - fars[a]) / (fars[b] - fars[a]);
    return [add(scale(corners[a], 1 - along), corners[b], along)];
  });
  const seen = [...corners.filter((_, i) => fars[i] >= NEAR), ...ends].map(project);
  if (!seen.length) return null;
  /** @param {"x" | "y"} axis @param {number} side */ const range = (axis, side) => {
    const places = seen.map((one) => one[axis]);
    const first = Math.floor((Math.min(...places) - 1) / step) * step;
    const end = Math.ceil((Math.max(...places) + 1) / step) * step;
    return [Math.max(0, first), Math.min(side, end)];
  };
  const [[left, rightEnd], [top, bottom]] = [range("x", size[0]), range("y", size[1])];
  if (left >= rightEnd || top >= bottom) return null;
  return { at: [left, top], size: [rightEnd - left, bottom - top] };
}

/** The camera whose frames of the part's size are that part of frames of `size`, pixel by pixel. @param {Registers}
 * registers @param {Size} size @param {Part} part @returns {Registers} */
export function partCamera({ position, look, right, up }, size, { at, size: partSize }) {
  const [aside, down] = [0, 1].map((i) => at[i] - Math.floor(size[i] / 2) + Math.floor(partSize[i] / 2));
  return { position, look: add(add(look, right, aside), up, -down), right, up };
}
