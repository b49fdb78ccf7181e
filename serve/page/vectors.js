// Vectors of three numbers.

export const add = (a, b, factor = 1) => a.map((value, axis) => value + b[axis] * factor);
export const subtract = (a, b) => add(a, b, -1);
export const dot = (a, b) => a.reduce((sum, value, axis) => sum + value * b[axis], 0);
export const length = (a) => Math.hypot(...a);
export const scale = (a, factor) => a.map((value) => value * factor);
export const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
