// How somebody walks among voxels: gravity, walls, steps and jumps. Lengths are in voxels, times in seconds. Functions
// return new values and read nothing else: `meets` tells whether a box overlaps what is solid.

import { add } from "./vectors.js";
/** @import { Box } from "./camera.js" @import { Vector } from "./vectors.js" */

const GAP = 1 / 1024; // between a body and what it touches
const STRIDE = 0.5; // the farthest that a body moves between two looks at what it meets
const LONGEST = 0.1; // seconds per step: a page that was hidden goes on where it was
const EASE = 14; // per second: how soon the eye is up after a step
const PERSON = { eye: 1.6, height: 1.8, radius: 0.3, step: 0.4, pace: 4.3, jump: 1.25, gravity: 26 }; // metres
const LEAST = 1.6; // voxels to the eye: whoever walks stands in a tunnel of two voxels
const SMALL = 1 / 12; // part of the world's side that the eye is above the ground at most

/** @typedef {(low: Vector, high: Vector) => boolean} Meets */

/** `eye`: its height; `radius`: half the width; `step`: the highest that is climbed without a jump, whole voxels;
 * `pace`: per second; `jump`: its height. @typedef {typeof PERSON} Body */

/** `place`: the middle of the soles; `rise`: upwards per second; `stands`: on something; `lag`: how much lower than usual
 * the eye is, since the body has just climbed. @typedef {{ place: Vector, rise: number, stands: boolean, lag: number }}
 * Walk */

/** `right`, `forward`: -1 … 1; `yaw`: where forward is, as that of a pose; `pace`: times that of the body. @typedef {{
 * right: number, forward: number, yaw: number, pace: number, jump: boolean }} Wish */

/** A body of usual size where voxels have a known size in metres; smaller in small worlds. @param {number | null}
 * voxelSize @param {number} side voxels @param {number} [tallest] voxels to the eye @returns {Body} */
export function bodyFor(voxelSize, side, tallest = Infinity) {
  const eye = Math.max(LEAST, Math.min(PERSON.eye / (voxelSize ?? Infinity) || side / 32, side * SMALL, tallest));
  const scale = eye / PERSON.eye;
  const { height, radius, step, pace, jump, gravity } = PERSON;
  return {
    eye,
    height: height * scale,
    radius: radius * scale,
    step: Math.max(1, Math.floor(step * scale)),
    pace: pace * scale,
    jump: jump * scale,
    gravity: gravity * scale,
  };
}

/** Where a body is. @param {Vector} place @param {Body} body @returns {Box} */
export const bodyBox = ([x, y, z], { radius, height }) => [
  [x - radius, y, z - radius],
  [x + radius, y + height, z + radius],
];

/** Where the eye is. @param {Walk} walk @param {Body} body */
export const eyeOf = ({ place, lag }, { eye }) => add(place, [0, eye - lag, 0]);

/** The place at or above one where a body has room; null where there is none up to `top`. @param {Vector} place @param
 * {Body} body @param {number} top @param {Meets} meets */
export function roomAbove([x, y, z], body, top, meets) {
  for (let at = y; at <= top; at = Math.floor(at) + 1) {
    const place = [x, at + GAP, z];
    if (!meets(...bodyBox(place, body))) return place;
  }
  return null;
}

/** @param {Walk} walk @param {Body} body @param {Wish} wish @param {number} seconds @param {Meets} meets @returns {Walk} */
export function step(walk, body, wish, seconds, meets) {
  const time = Math.min(seconds, LONGEST);
  const lag = walk.lag * Math.exp(-EASE * time);
  if (meets(...bodyBox(walk.place, body))) {
    const place = add(walk.place, [0, body.pace * time, 0]); // out of what was built around it
    return { place, rise: 0, stands: false, lag };
  }
  const gone = go(walk, body, wish, time, meets);
  const jumps = wish.jump && walk.stands;
  const rise = (jumps ? Math.sqrt(2 * body.gravity * body.jump) : walk.rise) - body.gravity * time;
  const fallen = slide(gone, 1, rise * time, body, meets);
  if (fallen.blocked) return { place: fallen.place, rise: 0, stands: rise <= 0, lag: lag + gone[1] - walk.place[1] };
  // Down a step, the soles stay on the ground.
  const down = walk.stands && !jumps ? slide(fallen.place, 1, -body.step, body, meets) : null;
  if (!down?.blocked) return { place: fallen.place, rise, stands: false, lag };
  return { place: down.place, rise: 0, stands: true, lag: lag + down.place[1] - walk.place[1] };
}

/** Where a body comes that walks on its level, or up a step. @param {Walk} walk @param {Body} body @param {Wish} wish
 * @param {number} time @param {Meets} meets */
function go({ place, stands }, body, { right, forward, yaw, pace }, time, meets) {
  const length = Math.max(1, Math.hypot(right, forward));
  const way = (body.pace * pace * time) / length;
  const [sin, cos] = [Math.sin(yaw) * way, Math.cos(yaw) * way];
  const [x, z] = [sin * forward + cos * right, sin * right - cos * forward];
  /** @param {Vector} from */ const across = (from) => {
    const aside = slide(from, 0, x, body, meets);
    const ahead = slide(aside.place, 2, z, body, meets);
    return { place: ahead.place, blocked: aside.blocked || ahead.blocked };
  };
  const level = across(place);
  if (!level.blocked || !stands) return level.place;
  /** @param {Vector} end */ const gain = (end) => Math.hypot(end[0] - place[0], end[2] - place[2]);
  for (let up = 1; up <= body.step; up++) {
    const raised = slide(place, 1, up + GAP, body, meets);
    if (raised.blocked) break;
    const above = across(raised.place).place;
    if (gain(above) > gain(level.place) + GAP) return slide(above, 1, -up, body, meets).place;
  }
  return level.place;
}

/** Move along an axis, up to what is met. @param {Vector} place @param {number} axis @param {number} way @param {Body}
 * body @param {Meets} meets */
function slide(place, axis, way, body, meets) {
  const sign = Math.sign(way);
  let [at, left] = [place, Math.abs(way)];
  while (left > 0) {
    const next = at.map((value, i) => (i === axis ? value + sign * Math.min(left, STRIDE) : value));
    const box = bodyBox(next, body);
    if (meets(...box)) {
      const edge = bodyBox(at, body)[sign > 0 ? 1 : 0][axis]; // the plane between voxels is behind it
      const plane = sign > 0 ? Math.ceil(edge) - GAP : Math.floor(edge) + GAP;
      const room = Math.max(0, sign * (plane - edge));
      return { place: at.map((value, i) => (i === axis ? value + sign * room : value)), blocked: true };
    }
    at = next;
    left -= STRIDE;
  }
  return { place: at, blocked: false };
}
