// Requests of frames: each asks for the newest view, at a size that suits the device. At most two wait for their frames,
// one where frames are slow; later changes are sent together with the next one.

import { alignedRegisters } from "./camera.js";
import { Resolution } from "./resolution.js";
/** @import { Pose, Registers, Size } from "./camera.js" @import { Device, Frame, View } from "./protocol.js" */

const REST = 180; // milliseconds without a change, until finer frames are asked for
const LONG_REST = 1200; // before frames that are announced
const SLOW = 0.3; // seconds
const ANNOUNCED = 1; // seconds: longer frames are announced

/** @typedef {{ size: Size, samples: number }} Wanted a frame; `samples`: columns and rows per pixel of the picture */

/** What renders: a connection to a server, or workers of the page. `sent`: when frames were requested that have not
 * arrived, by request. @typedef {{ hello: { viewer: number, device: Device } | null, sent: Map<number, number>,
 * changeView: (fields: Partial<View> & { camera: Registers, size: Size }) => number }} Renderer */

export class FrameRequests {
  resolution = new Resolution();
  changed = false;
  /** @type {Partial<View>} all but camera and size, that the renderer does not have yet */ #fields = {};
  #changedAt = 0;
  /** @type {Wanted} the newest request */ #shown = { size: [1, 1], samples: 1 };
  /** @type {Map<number, number>} columns and rows per pixel, by request */ #samples = new Map();
  #shape = "";
  #frameAt = 0;

  /** @param {Renderer} renderer @param {HTMLElement} stage */ constructor(renderer, stage) {
    this.renderer = renderer;
    this.stage = stage;
  }

  get device() {
    const { hello } = this.renderer;
    if (!hello) throw new Error("there is no connection to the server");
    return hello.device;
  }

  /** The shape of the picture at rest. */
  get size() {
    return this.resolution.finest(this.stage, this.device).size;
  }

  /** The camera of a frame, which shows what the finest one shows. @param {Pose} view @param {Size} size */
  registers(view, size) {
    const finest = this.size.map((side) => 2 * side);
    return alignedRegisters(view, size, finest[0] > size[0] ? finest : size);
  }

  /** Seconds that the frame takes for which the page waits, and since when; null for quick frames. */
  get waiting() {
    const [since] = this.renderer.sent.values();
    const seconds = this.resolution.seconds(this.#shown.size);
    return since === undefined || seconds < ANNOUNCED ? null : { since, seconds };
  }

  /** @param {Partial<View>} fields */ change(fields = {}) {
    Object.assign(this.#fields, fields);
    this.changed = true;
    this.#changedAt = performance.now();
    this.showBusy(true);
  }

  /** Scripts and screen readers learn whether a finer picture will follow. @param {boolean} busy */ showBusy(busy) {
    if (this.stage.getAttribute("aria-busy") !== String(busy)) this.stage.setAttribute("aria-busy", String(busy));
  }

  /** Forget what was not sent, since another view counts now. */
  discard() {
    this.changed = false;
    this.#fields = {};
  }

  /** Ask for a coarse frame if fine ones are slow: the next scene is then shown soon. @param {Pose} view */
  coarsen(view) {
    if (this.resolution.seconds(this.#shown.size) > SLOW)
      this.send(view, this.resolution.moving(this.stage, this.device));
  }

  /** Called once per frame of the screen. Returns whether the finest frame of the newest view is shown. @param
   * {Pose} view @param {boolean} busy while keys or the mouse are held */
  step(view, busy) {
    const waiting = this.renderer.sent.size;
    const seconds = this.resolution.seconds(this.#shown.size);
    if (this.changed) {
      // A frame that is announced is dropped when the server learns that the view has changed.
      const most = seconds > SLOW && seconds <= ANNOUNCED ? 1 : 2;
      if (waiting < most) this.send(view, this.resolution.moving(this.stage, this.device));
    } else if (waiting === 0 && performance.now() - this.#changedAt > REST) {
      const next = this.resolution.next(this.stage, this.device, this.#shown.size);
      const long = this.resolution.seconds(next.size) > ANNOUNCED;
      if (long && performance.now() - this.#changedAt < LONG_REST) return false;
      const finer = next.size[0] * next.samples > this.#shown.size[0] * this.#shown.samples;
      const reshaped = this.#shape !== this.size.join();
      if (!finer && !reshaped) return true;
      if (!busy || this.resolution.seconds(next.size) <= SLOW) this.send(view, next);
    }
    return false;
  }

  /** @param {Pose} view @param {Wanted} wanted */ send(view, { size, samples }) {
    const columns = size.map((side) => side * samples);
    const number = this.renderer.changeView({ camera: this.registers(view, columns), size: columns, ...this.#fields });
    this.#samples.set(number, samples);
    this.#shown = { size, samples };
    this.#shape = this.size.join();
    this.discard();
  }

  /** Learn from a frame; returns its columns and rows per pixel. @param {Frame} frame */
  receive(frame) {
    const now = performance.now();
    const mine = frame.viewer === this.renderer.hello?.viewer;
    const waited = frame.requested ? (now - Math.max(frame.requested, this.#frameAt)) / 1000 : 0;
    this.#frameAt = now;
    this.resolution.measure([frame.width, frame.height], Math.max(frame.seconds, waited, 1e-4));
    if (!mine) return 1;
    for (const number of this.#samples.keys()) if (number < frame.request) this.#samples.delete(number);
    return this.#samples.get(frame.request) ?? 1;
  }
}
