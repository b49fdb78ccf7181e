// Mouse and touch on the picture, as in three.js and Sketchfab: drag orbits; right, middle or Shift drag pans; wheel and
// pinch dolly; two fingers pan; a double click or double tap focuses.

const WHEEL = 0.001; // per pixel that the wheel scrolls
const PINCH = 0.01; // a trackpad's pinch arrives as a wheel with Ctrl
const LINE = 16; // pixels
const TAP = { seconds: 0.4, pixels: 12 };
/** @typedef {{ x: number, y: number }} Place of the page, in pixels */

/** What gestures do; right and down are pixels of the page. @typedef {{ turn: (right: number, down: number) => void,
 * pan: (right: number, down: number) => void, dolly: (factor: number) => void, focus: (x: number, y: number) =>
 * void }} Actions */

/** A pointer goes on belonging to an element that it leaves. A locked mouse has no pointer. @param {Element} element
 * @param {number} id */
export function capture(element, id) {
  if (!document.pointerLockElement) element.setPointerCapture(id);
}

export class Gestures {
  /** @type {Map<number, Place & { pans: boolean }>} by id */ pointers = new Map();
  /** @type {Place & { spread: number }} where the pointers were when the camera moved last */
  #done = { x: 0, y: 0, spread: 0 };
  /** @type {Place | null} where the only pointer was pressed */ #began = null;
  /** @type {(Place & { time: number }) | null} the last one */ #tap = null;
  turning = 0; // the button of a mouse whose drag turns; others pan

  /** @param {HTMLCanvasElement} canvas @param {Actions} actions */ constructor(canvas, actions) {
    this.canvas = canvas;
    this.actions = actions;
    canvas.addEventListener("pointerdown", (event) => this.begin(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const type of /** @type {const} */ (["pointerup", "pointercancel"]))
      canvas.addEventListener(type, (event) => this.finish(event));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        const pixels = event.deltaY * (event.deltaMode ? LINE : 1);
        actions.dolly(Math.exp(pixels * (event.ctrlKey ? PINCH : WHEEL)));
      },
      { passive: false },
    );
  }

  get active() {
    return this.pointers.size > 0;
  }

  /** @param {PointerEvent} event */ begin(event) {
    this.canvas.focus();
    capture(this.canvas, event.pointerId);
    const turning = event.pointerType === "touch" ? 0 : this.turning;
    const pans = event.button !== turning || event.shiftKey || event.ctrlKey || event.metaKey;
    this.step();
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY, pans });
    this.#done = this.place();
    this.#began = this.pointers.size === 1 && event.button === 0 ? { x: event.clientX, y: event.clientY } : null;
  }

  /** @param {PointerEvent} event */ move(event) {
    const pointer = this.pointers.get(event.pointerId);
    if (pointer) Object.assign(pointer, { x: event.clientX, y: event.clientY });
  }

  /** The middle of the pointers, and the distance of the first two. */
  place() {
    const all = [...this.pointers.values()];
    const [a, b] = all;
    /** @param {"x" | "y"} axis */
    const middle = (axis) => all.reduce((sum, pointer) => sum + pointer[axis], 0) / all.length;
    return { x: middle("x"), y: middle("y"), spread: b ? Math.hypot(a.x - b.x, a.y - b.y) : 0 };
  }

  /** Called once per frame of the screen: move the camera as far as all pointers have moved since. */
  step() {
    if (!this.active) return;
    const done = this.#done;
    this.#done = this.place();
    const [right, down] = [this.#done.x - done.x, this.#done.y - done.y];
    const pans = this.pointers.values().next().value?.pans;
    if (right || down) this.actions[pans || this.pointers.size > 1 ? "pan" : "turn"](right, down);
    if (done.spread && this.#done.spread !== done.spread) this.actions.dolly(done.spread / (this.#done.spread || 1));
  }

  /** @param {PointerEvent} event */ finish(event) {
    if (!this.pointers.has(event.pointerId)) return;
    this.step();
    this.pointers.delete(event.pointerId);
    this.#done = this.place();
    /** @param {Place | null} place */ const near = (place) =>
      place !== null && Math.hypot(event.clientX - place.x, event.clientY - place.y) <= TAP.pixels;
    if (event.type !== "pointerup" || !near(this.#began)) return;
    const now = performance.now();
    const second = near(this.#tap) && now - (this.#tap?.time ?? 0) < TAP.seconds * 1000;
    this.#tap = second ? null : { x: event.clientX, y: event.clientY, time: now };
    if (second) this.actions.focus(event.clientX, event.clientY);
  }
}
