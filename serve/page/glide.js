// A glide of the camera from one pose to another, for focus, frame and the preset views.

import { axes, target } from "./camera.js";
import { add, scale } from "./vectors.js";
/** @import { Pose } from "./camera.js" */

const SECONDS = 0.35;
const calm = matchMedia("(prefers-reduced-motion: reduce)");

export class Glide {
  /** @type {{ from: Pose, end: Pose, began: number, direct: boolean } | null} */ #way = null;

  /** @param {Pose} from @param {Pose} end */ start(from, end, direct = false) {
    this.#way = { from, end, began: performance.now(), direct: direct || calm.matches };
  }

  stop() {
    this.#way = null;
  }

  /** The pose now, or null when there is no glide. Target, angles and the logarithm of the distance change evenly. */
  step() {
    if (!this.#way) return null;
    const { from, end, began, direct } = this.#way;
    const part = direct ? 1 : Math.min(1, (performance.now() - began) / 1000 / SECONDS);
    if (part === 1) {
      this.#way = null;
      return end;
    }
    const eased = part * part * (3 - 2 * part);
    /** @param {number} a @param {number} b */ const mix = (a, b) => a + (b - a) * eased;
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
