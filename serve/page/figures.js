// The figures of the newest frames, over the picture.

import { element } from "./elements.js";
/** @import { Frame } from "./protocol.js" */

const WINDOW = 2000; // milliseconds over which frames are counted

export class Figures {
  /** @type {Frame | null} */ newest = null;
  /** @type {number[]} when frames have arrived */ #times = [];
  #missed = 0;
  #samples = 1;
  /** @type {number | null} */ #latency = null;

  /** @param {HTMLElement} list */ constructor(list) {
    this.list = list;
  }

  /** @param {Frame} frame @param {number} samples columns and rows per pixel */ add(frame, samples) {
    const now = performance.now();
    if (this.newest && frame.sequence > this.newest.sequence + 1)
      this.#missed += frame.sequence - this.newest.sequence - 1;
    this.newest = frame;
    this.#samples = samples;
    this.#times = [...this.#times.filter((time) => now - time < WINDOW), now];
    if (frame.requested) this.#latency = now - frame.requested;
  }

  /** Frames per second while frames arrive; 0 when they have stopped. */
  rate() {
    const now = performance.now();
    const recent = this.#times.filter((time) => now - time < WINDOW);
    return recent.length < 2 ? 0 : ((recent.length - 1) * 1000) / (recent[recent.length - 1] - recent[0]);
  }

  show() {
    const frame = this.newest;
    if (!frame) return;
    const shape = [frame.width, frame.height].map((side) => side / this.#samples).join(" × ");
    const rows = [
      ["frames per second", this.rate() ? this.rate().toFixed(1) : "idle"],
      ["latency", this.#latency === null ? "–" : `${this.#latency.toFixed(0)} ms`],
      ["render time", `${(frame.seconds * 1000).toFixed(1)} ms`],
      ["picture", shape],
      ["rays per pixel", String(this.#samples ** 2)],
      ...(frame.cycles === null ? [] : [["cycles per ray", (frame.cycles / frame.rays).toFixed(2)]]),
      ...(frame.words === null ? [] : [["words per ray", (frame.words / frame.rays).toFixed(2)]]),
      ["frame", frame.sequence.toLocaleString() + (this.#missed ? ` (${this.#missed} missed)` : "")],
    ];
    this.list.replaceChildren(...rows.flatMap(([name, value]) => [element("dt", {}, name), element("dd", {}, value)]));
  }
}
