// A camera, and other numbers, as links carry them. A camera has seven, the eye first.

import { FIELD_OF_VIEW } from "./camera.js";
/** @import { Pose } from "./camera.js" */

/** @typedef {Pick<Pose, "eye" | "yaw" | "pitch" | "fov" | "distance">} Placed */

const NUMBER = /^-?\d+(\.\d+)?(e[+-]?\d+)?$/;

/** The numbers of a list; NaN for what is none. @param {string} text */
export const numbersOf = (text) => text.split(",").map((part) => (NUMBER.test(part) ? Number(part) : Number.NaN));

/** @param {Placed} view */
export const cameraText = ({ eye, yaw, pitch, fov, distance }) =>
  [...eye, yaw, pitch, fov, distance].map((value) => Number(value.toFixed(3))).join(",");

/** What such a text says; null for one that says nothing. @param {string | null} text @returns {Placed | null} */
export function readCamera(text) {
  const numbers = numbersOf(text ?? "");
  if (numbers.length !== 7 || !numbers.every(Number.isFinite)) return null;
  const [x, y, z, yaw, pitch, fov, distance] = numbers;
  const isSeeing = fov >= FIELD_OF_VIEW.min && fov <= FIELD_OF_VIEW.max && distance > 0;
  return isSeeing ? { eye: [x, y, z], yaw, pitch, fov, distance } : null;
}
