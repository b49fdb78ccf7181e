// Vectors of three numbers.

/** @typedef {readonly number[]} Vector three numbers */

/** @param {Vector} a @param {Vector} b */
export const add = (a, b, factor = 1) => a.map((value, axis) => value + b[axis] * factor);
/** @param {Vector} a @param {Vector} b */ export const subtract = (a, b) => add(a, b, -1);

/** @param {Vector} a @param {Vector} b */
export const dot = (a, b) => a.reduce((sum, value, axis) => sum + value * b[axis], 0);

/** @param {Vector} a @param {Vector} b */
export const cross = ([ax, ay, az], [bx, by, bz]) => [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];
/** @param {Vector} a */ export const length = (a) => Math.hypot(...a);
/** @param {Vector} a @param {number} factor */ export const scale = (a, factor) => a.map((value) => value * factor);

/** @param {number} value @param {number} low @param {number} high */
export const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
