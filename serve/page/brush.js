// The voxels that a tool changes around one, and boxes: the lowest voxel, and one behind the highest.

/** @import { Box } from "./camera.js" @import { Vector } from "./vectors.js" */

/** The shape of a brush so many voxels across. @param {Vector} voxel @param {number} size */
export function brush(voxel, size) {
  if (size === 1) return { box: { low: voxel, high: voxel.map((place) => place + 1) } };
  return { sphere: { centre: voxel.map((place) => place + 0.5), radius: size / 2 } };
}

/** The box around it. @param {Vector} voxel @param {number} size @returns {Box} */
export const boxOf = (voxel, size) => [
  voxel.map((place) => Math.floor(place + (1 - size) / 2)),
  voxel.map((place) => Math.ceil(place + (1 + size) / 2)),
];

/** The box around two. @param {Box} one @param {Box} other @returns {Box} */
export const around = ([low, high], [otherLow, otherHigh]) => [
  low.map((place, axis) => Math.min(place, otherLow[axis])),
  high.map((place, axis) => Math.max(place, otherHigh[axis])),
];

/** Whether two boxes overlap. @param {Box} one @param {Box} other */
export const meet = ([low, high], [otherLow, otherHigh]) =>
  low.every((place, axis) => place < otherHigh[axis] && otherLow[axis] < high[axis]);

/** Whether the first box is inside the second. @param {Box} one @param {Box} other */
export const isInside = ([low, high], [otherLow, otherHigh]) =>
  low.every((place, axis) => place >= otherLow[axis] && high[axis] <= otherHigh[axis]);
