// Frames by several workers, each with an instance and a copy of the memory: a frame's rows of tiles are shared out among
// them in bands. To FrameRequests it is what a connection to a server is to the server's page.

import { Hand } from "./hand.js";

const TILE = 16; // rows of pixels
const BANDS = 3; // per worker: they cost differently
const MOST = 8; // workers
const MEMORY = 1 << 30; // bytes of words in all workers

export class Painter extends EventTarget {
  constructor(module) {
    super();
    this.module = module;
    this.hands = [];
    this.sent = new Map(); // request -> since when
    this.queue = []; // bands that no worker has yet
    this.request = 0;
    this.sequence = 0;
    this.scene = 0;
    this.hello = { viewer: 1, device: { name: "this browser", size: [4096, 4096], width_step: 1, position_limit: 2 ** 27, features: ["light", "mirrors"] } };
  }

  get workers() { return this.hands.length; }

  // Show another memory. `shading`: as of Voxrt.shade. Resolves when every worker has it.
  async load({ words, depth }, shading) {
    const wanted = Math.max(1, Math.min(navigator.hardwareConcurrency || 2, MOST, Math.floor(MEMORY / (4 * words.length))));
    this.scene++;
    this.sent.clear();
    this.queue = [];
    while (this.hands.length > wanted) this.hands.pop().stop();
    while (this.hands.length < wanted) this.hands.push(new Hand());
    await Promise.all(this.hands.map(async (hand) => {
      if (!hand.worker) await hand.start(this.module);
      await hand.call("memory", { words, depth, shading });
      hand.free = true;
    }));
  }

  shade(shading) { for (const hand of this.hands) hand.call("shade", { shading }).catch(() => {}); }

  follow(origin, direction) { return this.hands[0].call("follow", { origin, direction }); }
  census() { return this.hands[0].call("census"); }

  // Ask for a frame; returns its number.
  changeView({ camera, size }) {
    const [width, height] = size;
    const request = ++this.request;
    const since = performance.now();
    this.sent.set(request, since);
    const tiles = Math.ceil(height / TILE);
    const step = Math.max(1, Math.ceil(tiles / (BANDS * this.hands.length)));
    const job = { request, camera, size, since, scene: this.scene, left: Math.ceil(tiles / step), began: null, pixels: new Uint8Array(3 * width * height) };
    for (let first = 0; first < tiles; first += step) this.queue.push({ job, first, end: Math.min(first + step, tiles) });
    this.hands.forEach((hand) => this.next(hand));
    return request;
  }

  async next(hand) {
    if (!hand.free) return;
    const band = this.queue.shift();
    if (!band) return;
    const { job, first, end } = band;
    hand.free = false;
    job.began ??= performance.now();
    try {
      const { colour, top } = await hand.call("render", { camera: job.camera, size: job.size, first, end });
      job.pixels.set(colour, 3 * top * job.size[0]);
      hand.free = true;
      this.next(hand);
      if (--job.left === 0 && job.scene === this.scene) this.finish(job);
    } catch (error) {
      hand.free = true;
      if (job.scene !== this.scene) return;
      this.sent.delete(job.request);
      this.queue = this.queue.filter((waiting) => waiting.job !== job);
      this.dispatchEvent(new CustomEvent("trouble", { detail: error.message }));
    }
  }

  finish(job) {
    this.sent.delete(job.request);
    const [width, height] = job.size;
    this.dispatchEvent(new CustomEvent("frame", { detail: {
      viewer: 1, request: job.request, requested: job.since, width, height, pixels: job.pixels, camera: job.camera,
      seconds: (performance.now() - job.began) / 1000, rays: width * height, words: null, cycles: null, sequence: ++this.sequence,
    } }));
  }
}
