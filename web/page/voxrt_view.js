// <voxrt-view src="world.mem">: an octree memory as its exact picture, which turns under mouse, fingers and keys, in any
// page. The manifest world.json beside it gives colours, light and view. `make site` makes one file of this module.
//
// Attributes: src, the address of a .mem; or packed, a memory as links carry it; camera, as links carry it.

import { BandPicture } from "./band_picture.js";
import { measure } from "./camera.js";
import { readCamera } from "./camera_text.js";
import { firstView, limitOf } from "./first_view.js";
import { nameOf, stem } from "./folder.js";
import { FrameRequests } from "./frame_requests.js";
import { Gestures } from "./gestures.js";
import { FIRST_LOOK, nextLook, shadingOf } from "./looks.js";
import { boundsOf, worldOf } from "./memory.js";
import { dolly, frame, orbit, pan } from "./navigation.js";
import paintScript from "./paint_worker.txt";
import { Painter } from "./painter.js";
import { unpack } from "./packed.js";
import { readMem } from "./read_mem.js";
import { Viewpoint } from "./viewpoint.js";
import { Voxrt } from "./voxrt/voxrt.js";
import wasm from "./voxrt.wasm.zlib";
/** @import { Size } from "./camera.js" @import { Shown } from "./memory.js" */
/** @import { Move } from "./viewpoint.js" */

const TURN = Math.PI / 36; // per key
const NEARER = 1.1; // per key
const STILL = { active: false, step() {} }; // no keys are held
const STYLE = `
:host { display: block; position: relative; aspect-ratio: 4 / 3; overflow: hidden; }
:host([hidden]) { display: none; }
canvas { position: absolute; width: 100%; height: 100%; object-fit: contain; cursor: grab; touch-action: none; }
p { margin: 1em; }`;

let compiled = () => {
  const inflated = new Blob([wasm]).stream().pipeThrough(new DecompressionStream("deflate"));
  const module = new Response(inflated).arrayBuffer().then((bytes) => WebAssembly.compile(bytes));
  compiled = () => module;
  return module;
};

/** @param {string} src */ async function fetchMemory(src) {
  const url = new URL(src, document.baseURI);
  const manifest = new URL(url);
  manifest.pathname = url.pathname.replace(/(\.mem)?$/, ".json");
  const [mem, beside] = await Promise.all([fetch(url), fetch(manifest)]);
  if (!mem.ok) throw new Error(`${src}: the server answers ${mem.status}`);
  const file = async (/** @type {URL} */ from, /** @type {Response} */ answer) => ({
    name: nameOf(from),
    bytes: new Uint8Array(await answer.arrayBuffer()),
  });
  return Promise.all(beside.ok ? [file(url, mem), file(manifest, beside)] : [file(url, mem)]);
}

/** Wait until some of an element can be seen. @param {Element} one @returns {Promise<void>} */
const seen = (one) =>
  new Promise((resolve) => {
    const observer = new IntersectionObserver((entries) => {
      if (!entries.some(({ isIntersecting }) => isIntersecting)) return;
      observer.disconnect();
      resolve();
    });
    observer.observe(one);
  });

class VoxrtView extends HTMLElement {
  static observedAttributes = ["src", "packed", "camera"];
  #style = document.createElement("style");
  #status = document.createElement("p");
  #start = 0; // counts connections and memories: what was started before the last one is no longer wanted
  /** @type {Painter | null} */ #painter = null;

  constructor() {
    super();
    this.#style.textContent = STYLE;
    this.#status.setAttribute("role", "status");
    this.attachShadow({ mode: "open" }).append(this.#style, this.#status);
  }

  connectedCallback() {
    this.disconnectedCallback();
    const start = this.#start;
    this.#open(start).catch(({ message }) => start === this.#start && this.#say(message));
  }

  disconnectedCallback() {
    this.#start++;
    this.#painter?.stop();
    this.#painter = null;
  }

  attributeChangedCallback() {
    if (this.isConnected && this.#start) this.connectedCallback();
  }

  /** @param {number} start */ async #open(start) {
    const [src, packed] = [this.getAttribute("src"), this.getAttribute("packed")];
    if (!src && !packed) return;
    this.#say("Loading …");
    await seen(this);
    const module = await compiled();
    const [mem, beside] = await (packed ? unpack(packed) : fetchMemory(src ?? ""));
    const read = readMem(mem, beside);
    const depth = read.depth ?? (await Voxrt.load(module)).depthOf(read.words);
    const known = { name: stem(mem.name), file: mem.name };
    /** @type {Shown} */ const memory = { ...read, ...known, depth, voxels: [], bounds: worldOf(depth) };
    const look = nextLook(FIRST_LOOK, memory, null, true);
    const script = URL.createObjectURL(new Blob([paintScript], { type: "text/javascript" }));
    const painter = new Painter(module, script);
    try {
      await painter.load(memory, shadingOf(memory, look));
      const { outline } = await painter.census();
      if (start !== this.#start) return;
      this.#painter = painter;
      this.#show(painter, { ...memory, bounds: boundsOf(outline) ?? memory.bounds }, look.background);
    } finally {
      URL.revokeObjectURL(script);
      if (this.#painter !== painter) painter.stop();
    }
  }

  /** @param {Painter} painter @param {Shown} memory @param {number[]} background */
  #show(painter, memory, background) {
    const canvas = document.createElement("canvas");
    const label = `${memory.name}. Arrow keys turn, plus and minus dolly, F frames the scene.`;
    const known = { tabindex: "0", role: "application", "aria-roledescription": "3D view", "aria-label": label };
    for (const [name, value] of Object.entries(known)) canvas.setAttribute(name, value);
    canvas.style.backgroundColor = `rgb(${background.join()})`;
    this.shadowRoot?.replaceChildren(this.#style, canvas, this.#status);
    this.#say("");
    const picture = new BandPicture(canvas);
    const frames = new FrameRequests(painter, this);
    const viewpoint = new Viewpoint(frames);
    painter.on("trouble", (problem) => this.#say(problem));
    painter.on("frame", (bands) => picture.showBands(bands, frames.receive(bands)));
    const first = firstView(memory, frames.size);
    viewpoint.reset({ ...first, ...readCamera(this.getAttribute("camera")) });
    frames.change();
    const gestures = steer(canvas, viewpoint, memory, () => frames.size);
    const animate = () => {
      if (this.#painter !== painter) return;
      requestAnimationFrame(animate);
      if (this.clientWidth && this.clientHeight) viewpoint.step({ gestures, flight: STILL });
    };
    animate();
  }

  /** @param {string} text */ #say(text) {
    this.#status.hidden = !text;
    this.#status.textContent = text;
  }
}

/** Mouse, fingers and keys move the camera. @param {HTMLCanvasElement} canvas @param {Viewpoint} viewpoint @param
 * {Shown} memory @param {() => Size} size */
function steer(canvas, viewpoint, memory, size) {
  const limit = limitOf(memory);
  /** @param {Move} how */ const change = (how) => viewpoint.change(how);
  const across = () => measure([canvas.clientWidth, canvas.clientHeight]);
  /** @type {Record<string, () => void>} */ const keys = {
    ArrowLeft: () => change((now) => orbit(now, -TURN, 0)),
    ArrowRight: () => change((now) => orbit(now, TURN, 0)),
    ArrowUp: () => change((now) => orbit(now, 0, -TURN)),
    ArrowDown: () => change((now) => orbit(now, 0, TURN)),
    "+": () => change((now) => dolly(now, 1 / NEARER, limit)),
    "-": () => change((now) => dolly(now, NEARER, limit)),
    f: () => viewpoint.glide((now) => frame(now, memory.bounds, size(), limit)),
  };
  canvas.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || !keys[event.key]) return;
    event.preventDefault();
    keys[event.key]();
  });
  return new Gestures(canvas, {
    turn: (right, down) => {
      const angle = (2 * Math.PI) / canvas.clientHeight;
      change((now) => orbit(now, right * angle, down * angle));
    },
    pan: (right, down) => change((now) => pan(now, right / across(), down / across(), limit)),
    dolly: (factor) => change((now) => dolly(now, factor, limit)),
    focus: () => keys.f(),
  });
}

customElements.define("voxrt-view", VoxrtView);
