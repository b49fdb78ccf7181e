// The player of an animation: play and pause, and a slider with its frames.

import { $, isPressed, pressed } from "./elements.js";

const PERIOD = 0.1; // seconds from frame to frame, where the scene does not say

// `app` is that of main.js.
export class Player {
  constructor(app) {
    this.app = app;
    this.frames = 1;
    this.next = 0; // when the next frame is due
    $("play").onclick = () => this.play(!isPressed($("play")));
    $("frames").oninput = ({ target }) => {
      this.play(false);
      app.set({ frame: Number(target.value) });
    };
  }

  get playing() {
    return this.frames > 1 && isPressed($("play"));
  }

  play(on) {
    pressed($("play"), on);
    $("play").textContent = on ? "Pause" : "Play";
    this.next = performance.now();
  }

  show({ scene, view }) {
    const frames = scene.frames ?? 1;
    if (this.scene !== scene.number) this.play(frames > 1);
    Object.assign(this, { frames, scene: scene.number, period: 1000 * (scene.period ?? PERIOD) });
    $("player").hidden = frames === 1;
    $("frames").max = frames - 1;
    this.mark(view.frame);
  }

  mark(frame) {
    $("frames").value = frame;
    $("frame-number").textContent = `${frame + 1} / ${this.frames}`;
  }

  // Called once per frame of the screen: ask for the frame of the animation that is due, unless the last one still is
  // on its way. A device that is slower than the animation shows every frame, more slowly.
  step() {
    const now = performance.now();
    if (!this.playing || now < this.next || this.app.waits()) return;
    this.next = Math.max(this.next + this.period, now - this.period);
    const frame = (this.app.state().view.frame + 1) % this.frames;
    this.app.set({ frame });
    this.mark(frame);
  }
}
