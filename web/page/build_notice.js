// The notice of a build that takes longer than a moment: its stage, a bar where its length can be estimated, Cancel.

import { $, part } from "./elements.js";
import { dismiss, notice } from "./notices.js";

const SLOW = 250; // milliseconds until a build is announced
const TICK = 100; // milliseconds
const LONG = 1; // second: shorter builds have no bar

/** `seconds`: how long it will take, where that is known. @typedef {{ text: string, seconds?: number }} Stage */

export class BuildNotice {
  /** @type {Stage | null} */ stage = null;
  #since = performance.now();
  /** @type {ReturnType<typeof setInterval> | undefined} */ #ticks;

  /** @param {string} file @param {() => void} cancel */ constructor(file, cancel) {
    this.file = file;
    this.cancel = cancel;
    this.start = setTimeout(() => {
      this.#show();
      this.#ticks = setInterval(() => this.#move(), TICK);
    }, SLOW);
  }

  /** @param {Stage} stage */ enter(stage) {
    this.stage = stage;
    this.#since = performance.now();
    if (this.#ticks) this.#show();
  }

  end() {
    clearTimeout(this.start);
    clearInterval(this.#ticks);
  }

  #show() {
    const { text = "Building", seconds = 0 } = this.stage ?? {};
    const cancel = () => {
      this.end();
      dismiss();
      this.cancel();
    };
    const isLong = seconds > LONG;
    const about = isLong ? `: about ${Math.ceil(seconds)} s` : "";
    notice("progress", text, `${this.file}${about}`, { progress: isLong ? 0 : null, cancel });
    this.#move();
  }

  /** The bar never ends before the build. */
  #move() {
    const seconds = (performance.now() - this.#since) / 1000;
    part($("notice"), "progress").value = seconds / Math.max(this.stage?.seconds ?? 0, 1.05 * seconds, 0.001);
  }
}
