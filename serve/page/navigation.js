// What moves the camera: orbit, pan, dolly and focus around its target, and fly through the scene. Each function returns
// a new pose. Angles are in radians, distances in voxels.

import { axes, focal, target } from "./camera.js";
import { add, clamp, dot, scale, subtract } from "./vectors.js";
/** @import { Box, Pose, Size } from "./camera.js" @import { Vector } from "./vectors.js" */

const UPRIGHT = Math.PI / 2;
const NEAREST = 0.5; // voxels from the eye to the target
const REACH = { side: 0.9, top: 0.92, bottom: 0.8 }; // of a framed scene, in halves of the frame; tools stand at the bottom

/** Turn around the target: `right` and `down` are how far the front of the scene turns. @param {Pose} view @param
 * {number} right @param {number} down */
export function orbit(view, right, down) {
  const centre = target(view);
  const turned = look(view, right, -down);
  return { ...turned, eye: add(centre, axes(turned).look, -view.distance) };
}

/** Turn around the eye. @param {Pose} view @param {number} right @param {number} up */
export function look(view, right, up) {
  return { ...view, yaw: view.yaw + right, pitch: clamp(view.pitch + up, -UPRIGHT, UPRIGHT) };
}

/** Move eye and target in the plane of the picture. `right` and `down` are how far the scene moves, in parts of the
 * height across which the field of view counts. @param {Pose} view @param {number} right @param {number} down
 * @param {number} limit */
export function pan(view, right, down, limit) {
  const { right: rightward, up } = axes(view);
  const across = 2 * view.distance * Math.tan((view.fov * Math.PI) / 360);
  return within(view, add(add(view.eye, rightward, -right * across), up, down * across), limit);
}

/** Multiply the distance of the target. @param {Pose} view @param {number} factor @param {number} limit */
export function dolly(view, factor, limit) {
  const centre = target(view);
  const distance = clamp(view.distance * factor, NEAREST, limit);
  return within({ ...view, distance }, add(centre, axes(view).look, -distance), limit);
}

/** Make a point the target, and come closer. @param {Pose} view @param {Vector} point @param {number} limit */
export function focus(view, point, limit) {
  const distance = Math.max(NEAREST, Math.min(view.distance, dot(subtract(point, view.eye), axes(view).look)) * 0.6);
  return within({ ...view, distance }, add(point, axes(view).look, -distance), limit);
}

/** Move in voxels: right, up in the world, forward. @param {Pose} view @param {Vector} way @param {number} limit */
export function fly(view, [sideways, upwards, forwards], limit) {
  const { look: ahead, right } = axes(view);
  return within(view, add(add(add(view.eye, right, sideways), [0, 1, 0], upwards), ahead, forwards), limit);
}

/** Stand as near as all corners of a box (lowest and highest) stay in the frame, without turning. A point is in the
 * frame when its distance aside is at most a part of its depth, on both sides: linear in where the eye stands.
 * @param {Pose} view @param {Box} box @param {Size} size @param {number} limit */
export function frame(view, [low, high], [width, height], limit) {
  const { look: ahead, right, up } = axes(view);
  const corners = Array.from({ length: 8 }, (_, i) => [0, 1, 2].map((axis) => ((i >> axis) & 1 ? high : low)[axis]));
  const pixel = 1 / (2 * focal(view.fov, [width, height]));
  /** @type {[Vector, number, number, number][]} axis, side of the picture, reach before and after */ const sides = [
    [right, width, REACH.side, REACH.side],
    [up, height, REACH.bottom, REACH.top],
  ];
  const stands = sides.map(([axis, side, before, after]) => {
    const [low, high] = [-before * side * pixel, after * side * pixel];
    const first = Math.max(...corners.map((corner) => dot(corner, axis) - high * dot(corner, ahead)));
    const last = Math.min(...corners.map((corner) => dot(corner, axis) - low * dot(corner, ahead)));
    const aside = (/** @type {number} */ depth) => (first + last + (low + high) * depth) / 2;
    return { axis, depth: (last - first) / (high - low), aside };
  });
  const depth = Math.min(...stands.map((stand) => stand.depth));
  const eye = stands.reduce((place, stand) => add(place, stand.axis, stand.aside(depth)), scale(ahead, depth));
  const centre = scale(add(low, high), 0.5);
  return within({ ...view, distance: Math.max(NEAREST, dot(centre, ahead) - depth) }, eye, limit);
}

/** @param {Pose} view @param {Vector} eye @param {number} limit */
const within = (view, eye, limit) => ({ ...view, eye: eye.map((place) => clamp(place, -limit, limit)) });
