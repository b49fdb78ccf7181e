// A camera as links carry it: seven numbers, the eye first.

import { FIELD_OF_VIEW } from "./camera.js";
/** @import { Pose } from "./camera.js" */

/** @typedef {Pick<Pose, "eye" | "yaw" | "pitch" | "fov" | "distance">} Placed */

const NUMBER = /^-?\d+(\.\d+)?$/;

/** @param {Placed} view */
export const cameraText = ({ eye, yaw, pitch, fov, distance }) =>
  [...eye, yaw, pitch, fov, distance].map((value) => Number(value.toFixed(3))).join(",");

/** What such a text says; null for one that says nothing. @param {string | null} text @returns {Placed | null} */
export function readCamera(text) {
  const parts = text?.split(",") ?? [];
  if (parts.length !== 7 || !parts.every((part) => NUMBER.test(part))) return null;
  const [x, y, z, yaw, pitch, fov, distance] = parts.map(Number);
  const isSeeing = fov >= FIELD_OF_VIEW.min && fov <= FIELD_OF_VIEW.max && distance > 0;
  return isSeeing ? { eye: [x, y, z], yaw, pitch, fov, distance } : null;
}
