// Mouse and touch on the picture, as in three.js and Sketchfab: drag orbits; right, middle or Shift drag pans; wheel and
// pinch dolly; two fingers pan; a double click or double tap focuses.

const WHEEL = 0.001; // per pixel that the wheel scrolls
const PINCH = 0.01; // a trackpad's pinch arrives as a wheel with Ctrl
const LINE = 16; // pixels
const TAP = { seconds: 0.4, pixels: 12 };

// `actions` has turn(right, down), pan(right, down), dolly(factor) and focus(x, y); right and down are pixels of the page.
export class Gestures {
  constructor(canvas, actions) {
    this.canvas = canvas;
    this.actions = actions;
    this.pointers = new Map(); // id -> {x, y, pans}
    this.done = null; // where the pointers were when the camera moved last
    this.tap = null; // the last one: {x, y, time}
    canvas.addEventListener("pointerdown", (event) => this.begin(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const type of ["pointerup", "pointercancel"]) canvas.addEventListener(type, (event) => this.finish(event));
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

  begin(event) {
    this.canvas.focus();
    this.canvas.setPointerCapture(event.pointerId);
    const pans = event.button !== 0 || event.shiftKey || event.ctrlKey || event.metaKey;
    this.step();
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY, pans });
    this.done = this.place();
    this.began = this.pointers.size === 1 && event.button === 0 ? { x: event.clientX, y: event.clientY } : null;
  }

  move(event) {
    const pointer = this.pointers.get(event.pointerId);
    if (pointer) Object.assign(pointer, { x: event.clientX, y: event.clientY });
  }

  // The middle of the pointers, and the distance of the first two.
  place() {
    const all = [...this.pointers.values()];
    const [a, b] = all;
    const middle = (axis) => all.reduce((sum, pointer) => sum + pointer[axis], 0) / all.length;
    return { x: middle("x"), y: middle("y"), spread: b ? Math.hypot(a.x - b.x, a.y - b.y) : 0 };
  }

  // Called once per frame of the screen: move the camera as far as all pointers have moved since.
  step() {
    if (!this.active) return;
    const { done } = this;
    this.done = this.place();
    const [right, down] = [this.done.x - done.x, this.done.y - done.y];
    const [{ pans }] = this.pointers.values();
    if (right || down) this.actions[pans || this.pointers.size > 1 ? "pan" : "turn"](right, down);
    if (done.spread && this.done.spread !== done.spread) this.actions.dolly(done.spread / (this.done.spread || 1));
  }

  finish(event) {
    if (!this.pointers.has(event.pointerId)) return;
    this.step();
    this.pointers.delete(event.pointerId);
    this.done = this.place();
    const near = (place) => place && Math.hypot(event.clientX - place.x, event.clientY - place.y) <= TAP.pixels;
    if (event.type !== "pointerup" || !near(this.began)) return;
    const now = performance.now();
    const second = near(this.tap) && now - this.tap.time < TAP.seconds * 1000;
    this.tap = second ? null : { x: event.clientX, y: event.clientY, time: now };
    if (second) this.actions.focus(event.clientX, event.clientY);
  }
}
