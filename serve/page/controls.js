// Camera controls: keys, mouse, touch and gamepad move the camera once per frame of the screen.

import { move, turn, zoom } from "./camera.js";

const TURN = 1.6; // radians per second, by keys
const DRAG = 0.0045; // radians per pixel, at the usual field of view
const WHEEL = 0.0012;
const DEAD_ZONE = 0.15; // of the sticks of a gamepad
const MOVES = { KeyD: [0, 1], KeyA: [0, -1], KeyE: [1, 1], KeyQ: [1, -1], KeyW: [2, 1], KeyS: [2, -1] };
const TURNS = { ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowUp: [1, 1], ArrowDown: [1, -1] };
const ZOOMS = { Equal: -1, NumpadAdd: -1, Minus: 1, NumpadSubtract: 1 };

// `commands` maps key codes to functions; `change(f)` replaces the view by f(view); `world()` returns the side of the world
// and the largest distance of the camera from its corner, in voxels.
export class CameraControls {
  constructor(canvas, pad, { change, world, commands }) {
    this.change = change;
    this.world = world;
    this.held = new Set();
    this.pointers = new Map();
    const typing = (event) => event.target.closest?.("input, select, textarea, dialog, summary") !== null;
    const known = (code) => code in MOVES || code in TURNS || code in ZOOMS;
    addEventListener("keydown", (event) => {
      this.modifiers = event;
      if (event.ctrlKey || event.metaKey || typing(event)) return;
      if (known(event.code)) {
        this.held.add(event.code);
        event.preventDefault();
      } else if (commands[event.code] && !event.repeat) commands[event.code]();
    });
    addEventListener("keyup", (event) => { this.modifiers = event; this.held.delete(event.code); });
    addEventListener("blur", () => this.held.clear());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.change((view) => zoom(view, Math.exp(event.deltaY * (event.deltaMode ? 16 : 1) * WHEEL)));
    }, { passive: false });
    canvas.addEventListener("dblclick", () => canvas.requestPointerLock?.());
    canvas.addEventListener("pointerdown", (event) => {
      canvas.focus();
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, event);
    });
    canvas.addEventListener("pointermove", (event) => this.drag(canvas, event));
    for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => this.pointers.delete(event.pointerId));
    for (const button of pad.querySelectorAll("button")) {
      const { key } = button.dataset;
      button.addEventListener("pointerdown", () => this.held.add(key));
      for (const end of ["pointerup", "pointerleave", "pointercancel"]) button.addEventListener(end, () => this.held.delete(key));
    }
    this.last = performance.now();
  }

  drag(canvas, event) {
    const locked = document.pointerLockElement === canvas;
    const before = this.pointers.get(event.pointerId);
    if (!locked && !before) return;
    if (this.pointers.size === 2) {
      const spread = () => { const [a, b] = this.pointers.values(); return Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY); };
      const was = spread();
      this.pointers.set(event.pointerId, event);
      this.change((view) => zoom(view, was / (spread() || 1)));
      return;
    }
    const [dx, dy] = locked ? [event.movementX, event.movementY] : [event.clientX - before.clientX, event.clientY - before.clientY];
    if (before) this.pointers.set(event.pointerId, event);
    // A locked mouse turns the camera; a drag moves the picture with the pointer.
    const sense = locked ? 1 : -1;
    this.change((view) => {
      const step = DRAG * (view.fov / 35) * 0.5 * sense;
      return turn(view, dx * step * (view.flipX ? -1 : 1), -dy * step * (view.flipY ? -1 : 1));
    });
  }

  // Called once per frame of the screen.
  step() {
    const now = performance.now();
    const seconds = Math.min(0.1, (now - this.last) / 1000);
    this.last = now;
    const going = [0, 0, 0];
    const turning = [0, 0];
    let zooming = 0;
    for (const code of this.held) {
      if (code in MOVES) going[MOVES[code][0]] += MOVES[code][1];
      if (code in TURNS) turning[TURNS[code][0]] += TURNS[code][1];
      if (code in ZOOMS) zooming += ZOOMS[code];
    }
    for (const gamepad of navigator.getGamepads?.() ?? []) {
      if (!gamepad) continue;
      const stick = (axis) => (Math.abs(gamepad.axes[axis] ?? 0) > DEAD_ZONE ? gamepad.axes[axis] : 0);
      const trigger = (button) => gamepad.buttons[button]?.value ?? 0;
      going[0] += stick(0);
      going[2] -= stick(1);
      going[1] += trigger(7) - trigger(6);
      turning[0] += stick(2);
      turning[1] -= stick(3);
    }
    if (![...going, ...turning, zooming].some(Boolean)) return;
    const { side, limit } = this.world();
    const speed = side * 0.3 * seconds * (this.modifiers?.shiftKey ? 3 : 1) * (this.modifiers?.altKey ? 0.2 : 1);
    this.change((view) => {
      const mirrored = [view.flipX ? -1 : 1, view.flipY ? -1 : 1];
      const angle = TURN * seconds * Math.min(1, view.fov / 50);
      const moved = move(view, [going[0] * speed * mirrored[0], going[1] * speed, going[2] * speed], limit);
      return zoom(turn(moved, turning[0] * angle * mirrored[0], turning[1] * angle * mirrored[1]), Math.exp(zooming * seconds));
    });
  }
}
