// The camera of the page (eye, yaw, pitch, field of view, distance of its target), and its conversion from and to the
// camera registers: direction(column, row) = look + right * (column - W/2) + up * (H/2 - row), with right = look x up in
// a right-handed grid. The registers get the largest integers whose directions stay below 2**20.

import { add, clamp, dot, length, scale, subtract } from "./vectors.js";

const REGISTER_LIMIT = 32767;
const DIRECTION_LIMIT = (1 << 20) - 1;
export const FIELD_OF_VIEW = { min: 5, max: 140, usual: 35 };

/** @import { Vector } from "./vectors.js" */

/** @typedef {readonly number[]} Size columns and rows of a frame */
/** @typedef {[Vector, Vector]} Box its lowest and its highest corner */

/** The camera for people. The eye is in voxels. Yaw and pitch are in radians, both 0 for a look along -z. The field
 * of view is in degrees across the height of the largest 4:3 part of the frame, so that a page of any shape shows
 * as much. The distance is that from the eye to the target, around which the camera orbits, in voxels. Flips mirror
 * the picture. @typedef {{ eye: Vector, yaw: number, pitch: number, fov: number, distance: number, flipX: boolean,
 * flipY: boolean }} Pose */

/** `position`: in 1/16 voxel. @typedef {{ position: Vector, look: Vector, right: Vector, up: Vector }} Registers */

/** @param {Pick<Pose, "yaw" | "pitch">} angles */ export function axes({ yaw, pitch }) {
  const [sy, cy, sp, cp] = [Math.sin(yaw), Math.cos(yaw), Math.sin(pitch), Math.cos(pitch)];
  return { look: [cp * sy, sp, -cp * cy], right: [cy, 0, sy], up: [-sp * sy, cp, sp * cy] };
}

/** @param {Pose} view */ export const target = (view) => add(view.eye, axes(view).look, view.distance);
/** @param {Size} size */ export const measure = ([width, height]) => Math.min(0.75 * width, height);

/** @param {number} fov @param {Size} size */
export const focal = (fov, size) => measure(size) / (2 * Math.tan((fov * Math.PI) / 360));

/** @param {number} ahead @param {Size} size */
export const fieldOfView = (ahead, size) => (Math.atan(measure(size) / 2 / ahead) * 360) / Math.PI;

/** @param {Pose} view @param {Size} size */ export function toRegisters(view, size) {
  const { look, right, up } = axes(view);
  const sides = { right: scale(right, view.flipX ? -1 : 1), up: scale(up, view.flipY ? -1 : 1) };
  return {
    position: view.eye.map((value) => Math.round(value * 16)),
    ...rounded(scale(look, focal(view.fov, size)), sides, size),
  };
}

/** Registers whose frames show what those of a finer size show. Registers are coarse where pixels are many: without this
 * the picture would jump when it is refined. @param {Pose} view @param {Size} size @param {Size} finer */
export function alignedRegisters(view, size, finer) {
  const fine = toRegisters(view, finer);
  const factor = finer[0] / size[0];
  if (factor === 1) return fine;
  const sides = { right: scale(fine.right, factor), up: scale(fine.up, factor) };
  return { position: fine.position, ...rounded(fine.look, sides, size) };
}

/** Directions of any length as the largest registers that the hardware takes. @param {Vector} ahead @param {{ right:
 * Vector, up: Vector }} sides @param {Size} size */
function rounded(ahead, { right, up }, size) {
  const halves = size.map((side) => Math.floor(side / 2));
  const rounding = 1 + halves[0] + halves[1];
  const reaches = ahead.map((part, i) => Math.abs(part) + Math.abs(right[i]) * halves[0] + Math.abs(up[i]) * halves[1]);
  const largest = Math.max(...[...ahead, ...right, ...up].map(Math.abs));
  const factor = Math.min(REGISTER_LIMIT / largest, (DIRECTION_LIMIT - rounding) / Math.max(...reaches));
  /** @param {Vector} triple */ const whole = (triple) => triple.map((value) => Math.round(value * factor) + 0);
  return { look: whole(ahead), right: whole(right), up: whole(up) };
}

/** The pose of registers that were made for frames of `size`. The target is the point of the central ray that is
 * nearest to `centre`, the middle of the scene. For frames of another size, all that the registers show stays in
 * the picture. @param {Registers} registers @param {Size} size @param {Vector} centre */
export function fromRegisters({ position, look, right, up }, size, centre, shownSize = size) {
  const eye = position.map((value) => value / 16);
  const ahead = scale(look, 1 / (length(look) || 1));
  const pitch = Math.asin(clamp(ahead[1], -1, 1));
  // A look straight up or down has no yaw; then right gives it.
  const level = Math.hypot(look[0], look[2]) > 1e-6 * length(look);
  const yaw = level ? Math.atan2(ahead[0], -ahead[2]) : Math.atan2(right[2], right[0]);
  const upright = axes({ yaw, pitch });
  const fit = Math.min(shownSize[0] / size[0], shownSize[1] / size[1]);
  const towards = subtract(centre, eye);
  const fov = fieldOfView((fit * length(look)) / (length(right) || 1), shownSize);
  const distance = Math.max(dot(towards, ahead), length(towards) / 8, 1);
  const [flipX, flipY] = [dot(upright.right, right) < 0, dot(upright.up, up) < 0];
  return { eye, yaw, pitch, fov: clamp(fov, FIELD_OF_VIEW.min, FIELD_OF_VIEW.max), distance, flipX, flipY };
}

/** The direction of the ray through a pixel, as the hardware computes it. @param {Omit<Registers, "position">}
 * registers @param {Size} size @param {number} column @param {number} row */
export const pixelDirection = ({ look, right, up }, [width, height], column, row) =>
  look.map(
    (value, axis) => value + right[axis] * (column - Math.floor(width / 2)) + up[axis] * (Math.floor(height / 2) - row),
  );

/** @param {Pose} view @param {Vector} direction */ export function lookAlong(view, direction) {
  const size = length(direction);
  if (size < 1e-9) return view;
  const [x, y, z] = scale(direction, 1 / size);
  return { ...view, yaw: Math.hypot(x, z) > 1e-9 ? Math.atan2(x, -z) : view.yaw, pitch: Math.asin(clamp(y, -1, 1)) };
}
