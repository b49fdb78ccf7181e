// Frames by several workers, each with an instance and a copy of the memory: a frame's rows of tiles are shared out among
// them in bands. To FrameRequests it is what a connection to a server is to the server's page.
//
// Buffers of bands go to the workers and back. A frame keeps its bands until the next one is shown.

import { Hand } from "./hand.js";

const TILE = 16; // rows of pixels
const BANDS = 3; // per worker: they cost differently
const AHEAD = 2; // bands per worker: it renders one while the next one waits there
const MOST = 8; // workers
const MEMORY = 1 << 30; // bytes of words in all workers

export class Painter extends EventTarget {
  constructor(module) {
    super();
    this.module = module;
    this.hands = [];
    this.sent = new Map(); // request -> since when
    this.queue = []; // bands that no worker has yet
    this.buffers = new Map(); // length -> those that no band has
    this.shown = []; // bands of the newest frame
    this.request = 0;
    this.sequence = 0;
    this.scene = 0;
    this.hello = {
      viewer: 1,
      device: {
        name: "this browser",
        size: [4096, 4096],
        width_step: 1,
        position_limit: 2 ** 27,
        features: ["light", "mirrors"],
      },
    };
  }

  get workers() {
    return this.hands.length;
  }

  // Show another memory. `shading`: as of Voxrt.shade. Resolves when every worker has it.
  async load({ words, depth }, shading) {
    const wanted = Math.max(
      1,
      Math.min(navigator.hardwareConcurrency || 2, MOST, Math.floor(MEMORY / (4 * words.length))),
    );
    this.scene++;
    this.sent.clear();
    this.queue = [];
    while (this.hands.length > wanted) this.hands.pop().stop();
    while (this.hands.length < wanted) this.hands.push(new Hand());
    await Promise.all(
      this.hands.map(async (hand) => {
        hand.bands ??= AHEAD; // none before it has started
        if (!hand.worker)
          await hand.start(this.module).then(() => {
            hand.bands = 0;
          });
        await hand.call("memory", { words, depth, shading });
        this.next(hand);
      }),
    );
  }

  shade(shading) {
    for (const hand of this.hands) hand.call("shade", { shading }).catch(() => {});
  }

  follow(origin, direction) {
    return this.hands[0].call("follow", { origin, direction });
  }
  census() {
    return this.hands[0].call("census");
  }

  // Ask for a frame; returns its number.
  changeView({ camera, size }) {
    const [width, height] = size;
    const request = ++this.request;
    const since = performance.now();
    this.sent.set(request, since);
    const tiles = Math.ceil(height / TILE);
    const step = Math.max(1, Math.ceil(tiles / (BANDS * this.hands.length)));
    const job = {
      request,
      camera,
      size,
      since,
      scene: this.scene,
      left: Math.ceil(tiles / step),
      began: null,
      bands: [],
    };
    for (let first = 0; first < tiles; first += step)
      this.queue.push({ job, first, end: Math.min(first + step, tiles) });
    this.hands.forEach((hand) => this.next(hand));
    return request;
  }

  next(hand) {
    while (hand.bands < AHEAD && this.queue.length) this.render(hand, this.queue.shift());
  }

  async render(hand, { job, first, end }) {
    const [width, height] = job.size;
    const buffer = this.buffers.get(4 * width * (Math.min(TILE * end, height) - TILE * first))?.pop() ?? null;
    hand.bands++;
    job.began ??= performance.now();
    try {
      const { camera, size } = job;
      job.bands.push(
        await hand.call("render", { camera, size, first, end, buffer }, undefined, buffer ? [buffer] : []),
      );
      hand.bands--;
      this.next(hand);
      if (--job.left > 0) return;
      if (job.scene === this.scene) this.finish(job);
      else this.release(job.bands);
    } catch (error) {
      hand.bands--;
      if (job.scene !== this.scene) return;
      this.sent.delete(job.request);
      this.queue = this.queue.filter((waiting) => waiting.job !== job);
      this.dispatchEvent(new CustomEvent("trouble", { detail: error.message }));
    }
  }

  finish({ request, since, size: [width, height], bands, camera, began }) {
    this.sent.delete(request);
    this.dispatchEvent(
      new CustomEvent("frame", {
        detail: {
          viewer: 1,
          request,
          requested: since,
          width,
          height,
          bands,
          camera,
          seconds: (performance.now() - began) / 1000,
          rays: width * height,
          words: null,
          cycles: null,
          sequence: ++this.sequence,
        },
      }),
    );
    const lengths = new Set(bands.map(({ pixels }) => pixels.byteLength));
    for (const length of this.buffers.keys()) if (!lengths.has(length)) this.buffers.delete(length);
    this.release(this.shown.filter(({ pixels }) => lengths.has(pixels.byteLength)));
    this.shown = bands;
  }

  // Later bands may use the buffers of these.
  release(bands) {
    for (const {
      pixels: { buffer },
    } of bands) {
      if (!this.buffers.has(buffer.byteLength)) this.buffers.set(buffer.byteLength, []);
      this.buffers.get(buffer.byteLength).push(buffer);
    }
  }
}
