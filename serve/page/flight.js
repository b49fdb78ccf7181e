// Keys, the pad of buttons and gamepads: they move the camera once per frame of the screen as long as they are held.

const TURN = 1.6; // radians per second
const DOLLY = 1.2; // e-folds per second
const SPEED = 0.3; // sides of the world per second
const DEAD_ZONE = 0.15; // of the sticks of a gamepad
/** @typedef {Record<string, [number, number]>} Ways axis and sign by the code of a key */

/** @type {Ways} */
const MOVES = { KeyD: [0, 1], KeyA: [0, -1], KeyE: [1, 1], Space: [1, 1], KeyQ: [1, -1], KeyW: [2, 1], KeyS: [2, -1] };
/** @type {Ways} */ const TURNS = { ArrowRight: [0, 1], ArrowLeft: [0, -1], ArrowUp: [1, 1], ArrowDown: [1, -1] };
/** @type {Record<string, number>} */ const DOLLIES = { Equal: -1, NumpadAdd: -1, Minus: 1, NumpadSubtract: 1 };
const TYPES_TEXT = "select, dialog, input:is([type=text], [type=number], [type=password])";
const USES_SPACE = "button, summary, input, a";
const USES_ARROWS = `${TYPES_TEXT}, input, [role=toolbar]`;

/** @import { Commands } from "./tools.js" */

/** What keys do: `fly` takes sides of the world, `rotate` radians. @typedef {{ fly: (right: number, up: number,
 * forward: number) => void, rotate: (right: number, up: number) => void, dolly: (factor: number) => void, commands:
 * Commands }} Actions */

export class Flight {
  /** @type {Set<string>} codes of keys */ #held = new Set();
  #modifiers = { shiftKey: false, altKey: false };
  #last = performance.now();
  /** @type {{ active: boolean, step: () => void } | null} */ walker = null;

  /** @param {HTMLElement} pad @param {Actions} actions */ constructor(pad, actions) {
    this.actions = actions;
    addEventListener("keydown", (event) => this.press(event));
    addEventListener("keyup", (event) => {
      this.#modifiers = event;
      this.#held.delete(event.code);
    });
    addEventListener("blur", () => this.#held.clear());
    for (const button of pad.querySelectorAll("button")) {
      const { key = "" } = button.dataset;
      button.addEventListener("pointerdown", () => this.#held.add(key));
      for (const end of /** @type {const} */ (["pointerup", "pointerleave", "pointercancel"]))
        button.addEventListener(end, () => this.#held.delete(key));
    }
  }

  get active() {
    return this.#held.size > 0 || Boolean(this.walker?.active);
  }

  /** @param {KeyboardEvent} event */ press(event) {
    this.#modifiers = event;
    const { code } = event;
    const focused = event.target instanceof Element ? event.target : null;
    if (event.ctrlKey || event.metaKey || focused?.closest(TYPES_TEXT)) return;
    if (code === "Space" && focused?.closest(USES_SPACE)) return;
    // Arrows belong to the slider or the group of buttons that has the focus.
    if (code in TURNS && focused?.closest(USES_ARROWS)) return;
    if (code in MOVES || code in TURNS || code in DOLLIES) {
      this.#held.add(code);
      event.preventDefault();
    } else if (this.actions.commands[code] && !event.repeat) {
      event.preventDefault();
      this.actions.commands[code]();
    }
  }

  /** Whether the key for it is held. */
  get fast() {
    return this.#modifiers.shiftKey;
  }

  /** How far keys and gamepads go: right, up, forward, each about -1 … 1. */
  going() {
    const going = [0, 0, 0];
    for (const code of this.#held) if (code in MOVES) going[MOVES[code][0]] += MOVES[code][1];
    for (const gamepad of gamepads()) {
      going[0] += stick(gamepad, 0);
      going[2] -= stick(gamepad, 1);
      going[1] += trigger(gamepad, 7) - trigger(gamepad, 6);
    }
    return going;
  }

  /** Called once per frame of the screen. */
  step() {
    const now = performance.now();
    const seconds = Math.min(0.1, (now - this.#last) / 1000);
    this.#last = now;
    const going = this.going();
    const turning = [0, 0];
    let dollying = 0;
    for (const code of this.#held) {
      if (code in TURNS) turning[TURNS[code][0]] += TURNS[code][1];
      if (code in DOLLIES) dollying += DOLLIES[code];
    }
    for (const gamepad of gamepads()) {
      turning[0] += stick(gamepad, 2);
      turning[1] -= stick(gamepad, 3);
    }
    const speed = SPEED * seconds * (this.fast ? 3 : 1) * (this.#modifiers.altKey ? 0.2 : 1);
    if (going.some(Boolean)) this.actions.fly(going[0] * speed, going[1] * speed, going[2] * speed);
    if (turning.some(Boolean)) this.actions.rotate(turning[0] * TURN * seconds, turning[1] * TURN * seconds);
    if (dollying) this.actions.dolly(Math.exp(dollying * DOLLY * seconds));
    this.walker?.step();
  }
}

const gamepads = () => (navigator.getGamepads?.() ?? []).filter((gamepad) => gamepad !== null);

/** @param {Gamepad} gamepad @param {number} axis */
const stick = ({ axes }, axis) => (Math.abs(axes[axis] ?? 0) > DEAD_ZONE ? axes[axis] : 0);

/** @param {Gamepad} gamepad @param {number} button */ const trigger = ({ buttons }, button) =>
  buttons[button]?.value ?? 0;
