// The player of an animation: play and pause, and a slider with its frames.

import { $, isPressed, pressed } from "./elements.js";

const PERIOD = 0.1; // seconds from frame to frame, where the scene does not say

/** @import { App } from "./app.js" @import { State } from "./protocol.js" */

export class Player {
  #frames = 1;
  #period = 1000 * PERIOD; // milliseconds
  #next = 0; // when the next frame is due
  /** @type {number | null} */ #scene = null;

  /** @param {App} app */ constructor(app) {
    this.app = app;
    $("play").onclick = () => this.play(!isPressed($("play")));
    $("frames").oninput = () => {
      this.play(false);
      app.set({ frame: $("frames").valueAsNumber });
    };
  }

  get playing() {
    return this.#frames > 1 && isPressed($("play"));
  }

  /** @param {boolean} on */ play(on) {
    pressed($("play"), on);
    $("play").textContent = on ? "Pause" : "Play";
    this.#next = performance.now();
  }

  /** @param {State} state */ show({ scene, view }) {
    const frames = scene.frames ?? 1;
    this.#frames = frames;
    if (this.#scene !== scene.number) this.play(frames > 1);
    this.#scene = scene.number;
    this.#period = 1000 * (scene.period ?? PERIOD);
    $("player").hidden = frames === 1;
    $("frames").max = String(frames - 1);
    this.mark(view.frame);
  }

  /** @param {number} frame */ mark(frame) {
    $("frames").valueAsNumber = frame;
    $("frame-number").textContent = `${frame + 1} / ${this.#frames}`;
  }

  /** Called once per frame of the screen: ask for the frame of the animation that is due, unless the last one still
   * is on its way. A device that is slower than the animation shows every frame, more slowly. */
  step() {
    const now = performance.now();
    if (!this.playing || now < this.#next || this.app.waits()) return;
    this.#next = Math.max(this.#next + this.#period, now - this.#period);
    const frame = (this.app.state().view.frame + 1) % this.#frames;
    this.app.set({ frame });
    this.mark(frame);
  }
}
