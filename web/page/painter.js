// Frames by several workers, each with an instance and a copy of the memory: a frame's rows of tiles are shared out among
// them in bands. To FrameRequests it is what a connection to a server is to the server's page.
//
// Buffers of bands go to the workers and back. A frame keeps its bands until the next one is shown.

import { Events } from "./events.js";
import { Hand } from "./hand.js";
/** @import { Band, BandFrame } from "./band_picture.js" @import { Registers, Size } from "./camera.js" */
/** @import { Memory } from "./memory.js" @import { Vector } from "./vectors.js" */
/** @import { Look } from "./voxrt/voxrt.js" @import { Patch } from "./voxrt/world.js" */
/** @import { PaintCalls } from "./paint_worker.js" */

const TILE = 16; // rows of pixels
const BANDS = 3; // per worker, or more: they cost differently
const BAND = 1 << 18; // pixels that a band may have: the camera waits for as many when it starts to move
const AHEAD = 2; // bands per worker: it renders one while the next one waits there
const MOST = 8; // workers
const MEMORY = 1 << 30; // bytes of words in all workers
const LIMITS = { size: [4096, 4096], pixels: 1 << 24, smooth: 2, width_step: 1, position_limit: 2 ** 27 };
const DEVICE = { name: "this browser", features: ["light", "mirrors"], ...LIMITS };

/** A frame that is rendered. `since`: when it was requested; `edition`: patches of the memory by then; `left`: bands that
 * are not rendered; `aside`: who waits for a frame that is not shown. @typedef {{ request: number, camera: Registers,
 * size: Size, since: number, scene: number, edition: number, left: number, began: number | null, bands: Band[], aside:
 * Aside | null }} Job */

/** @typedef {{ resolve: (frame: BandFrame) => void, reject: (error: Error) => void }} Aside */

/** @typedef {{ job: Job, first: number, end: number }} Part of a frame: rows of tiles */
/** @typedef {{ hand: Hand<PaintCalls>, bands: number }} Artist a worker, and the bands that it has */

/** @extends {Events<{ frame: BandFrame, trouble: string }>} */ export class Painter extends Events {
  hello = { viewer: 1, device: DEVICE };
  /** @type {Map<number, number>} when frames were requested that have not arrived, by request */ sent = new Map();
  /** @type {Artist[]} */ #artists = [];
  /** @type {Part[]} that no worker has yet */ #queue = [];
  /** @type {Map<number, ArrayBuffer[]>} buffers that no band has, by length */ #buffers = new Map();
  /** @type {Band[]} of the newest frame */ #shown = [];
  edition = 0; // patches of the memory
  #request = 0;
  #sequence = 0;
  #scene = 0;

  /** @param {WebAssembly.Module} module @param {string} script that of paint_worker.js */
  constructor(module, script = "./paint_worker.js") {
    super();
    this.module = module;
    this.script = script;
  }

  /** Show another memory. Resolves when every worker has it. @param {Memory} memory @param {Look} shading */
  async load({ words, depth }, shading) {
    const fitting = Math.floor(MEMORY / (4 * words.length));
    const wanted = Math.max(1, Math.min(navigator.hardwareConcurrency || 2, MOST, fitting));
    this.#scene++;
    this.sent.clear();
    for (const { job } of this.#queue) job.aside?.reject(new Error("cancelled"));
    this.#queue = [];
    for (const { hand } of this.#artists.splice(wanted)) hand.stop();
    /** @type {Artist[]} */ const starting = [];
    while (this.#artists.length < wanted) {
      /** @type {Artist} */
      const artist = { hand: new Hand(this.script), bands: AHEAD }; // no more until it has started
      this.#artists.push(artist);
      starting.push(artist);
    }
    await Promise.all(
      this.#artists.map(async (artist) => {
        if (starting.includes(artist)) {
          await artist.hand.call("start", { module: this.module });
          artist.bands = 0;
        }
        await artist.hand.call("memory", { words, depth, shading });
        this.#next(artist);
      }),
    );
  }

  /** Write a patch into the memory of every worker. Frames that are requested from now on show it. @param {Patch} patch */
  patch(patch) {
    this.edition++;
    for (const { hand } of this.#artists)
      hand.call("patch", patch).catch(({ message }) => message !== "cancelled" && this.emit("trouble", message));
  }

  /** @param {Look} shading */ shade(shading) {
    for (const { hand } of this.#artists) hand.call("shade", { shading }).catch(() => {});
  }

  /** @param {Vector} origin @param {Vector} direction */ follow(origin, direction) {
    return this.#artists[0].hand.call("follow", { origin, direction });
  }

  /** End the workers. */
  stop() {
    this.#scene++;
    for (const { hand } of this.#artists.splice(0)) hand.stop();
  }

  census() {
    return this.#artists[0].hand.call("census", undefined);
  }

  /** Request a frame; returns its number. @param {{ camera: Registers, size: Size }} view */
  changeView({ camera, size }) {
    const request = ++this.#request;
    this.#drop(2 * size[0] * size[1]);
    this.sent.set(request, performance.now());
    this.#begin(request, camera, size, null);
    return request;
  }

  /** Leave frames of more pixels unfinished: the camera has moved since they were requested. @param {number} pixels */
  #drop(pixels) {
    this.#queue = this.#queue.filter(({ job }) => {
      const isStale = !job.aside && job.size[0] * job.size[1] > pixels;
      if (isStale) this.sent.delete(job.request);
      return !isStale;
    });
  }

  /** Render a frame that is not shown. Rejects when another memory comes first. @param {{ camera: Registers, size: Size
   * }} view @returns {Promise<BandFrame>} */
  picture({ camera, size }) {
    return new Promise((resolve, reject) => this.#begin(++this.#request, camera, size, { resolve, reject }));
  }

  /** @param {number} request @param {Registers} camera @param {Size} size @param {Aside | null} aside */
  #begin(request, camera, size, aside) {
    const tiles = Math.ceil(size[1] / TILE);
    const most = Math.ceil(BAND / (TILE * size[0]));
    const step = Math.max(1, Math.min(most, Math.ceil(tiles / (BANDS * this.#artists.length))));
    const left = Math.ceil(tiles / step);
    const since = performance.now();
    const known = { request, camera, size, since, scene: this.#scene, edition: this.edition, aside };
    /** @type {Job} */ const job = { ...known, left, began: null, bands: [] };
    for (let first = 0; first < tiles; first += step)
      this.#queue.push({ job, first, end: Math.min(first + step, tiles) });
    for (const artist of this.#artists) this.#next(artist);
  }

  /** @param {Artist} artist */ #next(artist) {
    while (artist.bands < AHEAD) {
      const part = this.#queue.shift();
      if (!part) return;
      this.#render(artist, part);
    }
  }

  /** @param {Artist} artist @param {Part} part */ async #render(artist, { job, first, end }) {
    const { camera, size } = job;
    const [width, height] = size;
    const length = 4 * width * (Math.min(TILE * end, height) - TILE * first);
    const buffer = this.#buffers.get(length)?.pop() ?? null;
    artist.bands++;
    job.began ??= performance.now();
    try {
      const view = { camera, size, first, end, buffer };
      job.bands.push(await artist.hand.call("render", view, undefined, buffer ? [buffer] : []));
      artist.bands--;
      this.#next(artist);
      if (--job.left > 0) return;
      if (job.scene === this.#scene) this.#finish(job, job.began);
      else {
        this.#release(job.bands);
        job.aside?.reject(new Error("cancelled"));
      }
    } catch (error) {
      artist.bands--;
      job.aside?.reject(/** @type {Error} */ (error));
      if (job.scene !== this.#scene) return;
      this.sent.delete(job.request);
      this.#queue = this.#queue.filter((waiting) => waiting.job !== job);
      if (!job.aside) this.emit("trouble", /** @type {Error} */ (error).message);
    }
  }

  /** @param {Job} job @param {number} began */
  #finish({ request, since, size: [width, height], bands, camera, edition, aside }, began) {
    this.sent.delete(request);
    const sequence = aside ? this.#sequence : ++this.#sequence;
    const ids = { viewer: this.hello.viewer, request, requested: since, sequence };
    const seconds = (performance.now() - began) / 1000;
    const figures = { seconds, rays: width * height, words: null, cycles: null };
    const frame = { ...ids, ...figures, width, height, bands, camera, edition };
    if (aside) return aside.resolve(frame);
    this.emit("frame", frame);
    const lengths = new Set(bands.map(({ pixels }) => pixels.byteLength));
    for (const length of this.#buffers.keys()) if (!lengths.has(length)) this.#buffers.delete(length);
    this.#release(this.#shown.filter(({ pixels }) => lengths.has(pixels.byteLength)));
    this.#shown = bands;
  }

  /** Later bands may use the buffers of these. @param {Band[]} bands */
  #release(bands) {
    for (const { buffer } of bands.map(({ pixels }) => pixels)) {
      const known = this.#buffers.get(buffer.byteLength) ?? [];
      this.#buffers.set(buffer.byteLength, [...known, buffer]);
    }
  }
}
