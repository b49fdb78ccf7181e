// A glide of the camera from one pose to another, for focus, frame and the preset views.

import { axes, target } from "./camera.js";
import { add, scale } from "./vectors.js";

const SECONDS = 0.35;
const calm = matchMedia("(prefers-reduced-motion: reduce)");

export class Glide {
  constructor() {
    this.end = null;
  }

  start(from, to, direct = false) {
    Object.assign(this, { from, end: to, began: performance.now(), direct: direct || calm.matches });
  }

  stop() {
    this.end = null;
  }

  // The pose now, or null when there is no glide. Target, angles and the logarithm of the distance change evenly.
  step() {
    const { from, end } = this;
    if (!end) return null;
    const part = this.direct ? 1 : Math.min(1, (performance.now() - this.began) / 1000 / SECONDS);
    if (part === 1) {
      this.end = null;
      return end;
    }
    const eased = part * part * (3 - 2 * part);
    const mix = (a, b) => a + (b - a) * eased;
    const turn = ((((end.yaw - from.yaw) % (2 * Math.PI)) + 3 * Math.PI) % (2 * Math.PI)) - Math.PI; // the shorter way
    const between = {
      ...end,
      yaw: from.yaw + turn * eased,
      pitch: mix(from.pitch, end.pitch),
      fov: mix(from.fov, end.fov),
      distance: Math.exp(mix(Math.log(from.distance), Math.log(end.distance))),
    };
    const middle = add(scale(target(from), 1 - eased), target(end), eased);
    return { ...between, eye: add(middle, axes(between).look, -between.distance) };
  }
}
