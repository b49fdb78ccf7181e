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
    this.tap = null; // the last one: {x, y, time}
    canvas.addEventListener("pointerdown", (event) => this.begin(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    for (const type of ["pointerup", "pointercancel"]) canvas.addEventListener(type, (event) => this.finish(event));
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      const pixels = event.deltaY * (event.deltaMode ? LINE : 1);
      actions.dolly(Math.exp(pixels * (event.ctrlKey ? PINCH : WHEEL)));
    }, { passive: false });
  }

  get active() { return this.pointers.size > 0; }

  begin(event) {
    this.canvas.focus();
    this.canvas.setPointerCapture(event.pointerId);
    const pans = event.button !== 0 || event.shiftKey || event.ctrlKey || event.metaKey;
    this.pointers.set(event.pointerId, { x: event.clientX, y: event.clientY, pans });
    this.began = this.pointers.size === 1 && event.button === 0 ? { x: event.clientX, y: event.clientY } : null;
  }

  move(event) {
    const pointer = this.pointers.get(event.pointerId);
    if (!pointer) return;
    const before = this.spread();
    const [right, down] = [event.clientX - pointer.x, event.clientY - pointer.y];
    Object.assign(pointer, { x: event.clientX, y: event.clientY });
    const fingers = this.pointers.size;
    if (fingers === 1) this.actions[pointer.pans ? "pan" : "turn"](right, down);
    else this.actions.pan(right / fingers, down / fingers);
    if (fingers === 2) this.actions.dolly(before / (this.spread() || 1));
  }

  // The distance of two fingers.
  spread() {
    const [a, b] = this.pointers.values();
    return b ? Math.hypot(a.x - b.x, a.y - b.y) : 0;
  }

  finish(event) {
    this.pointers.delete(event.pointerId);
    const near = (place) => place && Math.hypot(event.clientX - place.x, event.clientY - place.y) <= TAP.pixels;
    if (event.type !== "pointerup" || !near(this.began)) return;
    const now = performance.now();
    const second = near(this.tap) && now - this.tap.time < TAP.seconds * 1000;
    this.tap = second ? null : { x: event.clientX, y: event.clientY, time: now };
    if (second) this.actions.focus(event.clientX, event.clientY);
  }
}
