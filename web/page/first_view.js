// Where the camera stands when a memory is shown, and how far away it may go.

import { FIELD_OF_VIEW, fromRegisters, lookAlong } from "./camera.js";
import { frame } from "./navigation.js";
import { add, scale } from "./vectors.js";
/** @import { Size } from "./camera.js" @import { Shown } from "./memory.js" */

const CORNER = [-0.62, -0.55, -1];
const MADE_FOR = [640, 480]; // the cameras of manifests

/** The largest coordinate of the eye, voxels. @param {Pick<Shown, "depth">} memory */
export const limitOf = ({ depth }) => 8 * 2 ** depth + 512;

/** The view of the memory's author, or one from a corner. @param {Shown} memory @param {Size} size */
export function firstView(memory, size) {
  const { view, bounds } = memory;
  if (view?.look.some(Boolean)) return fromRegisters(view, MADE_FOR, scale(add(...bounds), 0.5), size);
  const plain = { fov: FIELD_OF_VIEW.usual, distance: 1, flipX: false, flipY: false };
  const origin = { eye: [0, 0, 0], yaw: 0, pitch: 0, ...plain };
  return frame(lookAlong(origin, CORNER), bounds, size, limitOf(memory));
}
