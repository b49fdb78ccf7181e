// Warnings by their message, each with a count.

/** @import { Warning } from "./scene_format.js" */

/** @typedef {(kind: string, message: string, count?: number) => void} Warn */

export class Warnings {
  /** @type {Map<string, Warning>} */ #known = new Map();

  /** @type {Warn} */ warn = (kind, message, count = 1) => {
    this.#known.set(message, { kind, message, count: (this.#known.get(message)?.count ?? 0) + count });
  };

  /** Those with a count above 0, in the order in which they came. */
  list() {
    return [...this.#known.values()].filter(({ count }) => count);
  }
}
