// Mouse and touch on the picture while a tool is on. Left uses the tool, right its counterpart; held buttons repeat; the
// middle button turns, and its click takes the material. A finger taps, or rests to repeat; moving, it turns the view.
//
// A press that hits nothing turns the view, too.

import { $ } from "./elements.js";
import { capture } from "./gestures.js";
/** @import { Gestures } from "./gestures.js" */

/** @typedef {"dig" | "build" | "paint"} Tool */

const FIRST = 320; // milliseconds until a held button repeats
const AGAIN = 120; // milliseconds between repeats
const TAP = 12; // pixels that a press may move
const FARTHER = 10; // pixels after which a tool acts without delay
const NOTCH = 50; // pixels of the wheel per material

/** @typedef {{ x: number, y: number }} Place of the page */

/** What the pointer does; `tool`: for a button, null for none. @typedef {{ tool: (button: number) => Tool | null, use:
 * (tool: Tool, place: Place, stroke: number) => Promise<{ hit: boolean } | null>, aim: (place: Place | null) => void, take:
 * (place: Place) => void, nextMaterial: (step: number) => void, locked: () => boolean }} PointerActions */

/** @typedef {Place & { id: number, event: PointerEvent, tool: Tool, stroke: number, acts: number, last: Place }} Held */

export class EditPointer {
  /** @type {Held | null} */ #held = null;
  /** @type {(Place & { id: number, timer: ReturnType<typeof setTimeout> }) | null} a finger that may tap */ #finger =
    null;
  /** @type {ReturnType<typeof setTimeout> | undefined} */ #timer;
  /** @type {Place | null} where the middle button was pressed */ #middle = null;
  #isActing = false;
  #strokes = 0;
  #wheel = 0;

  /** @param {Gestures} gestures @param {PointerActions} actions */ constructor(gestures, actions) {
    this.gestures = gestures;
    this.actions = actions;
    const stage = $("stage");
    /** @param {(event: PointerEvent) => void} handle @returns {(event: PointerEvent) => void} */
    const onPicture = (handle) => (event) => event.target === $("picture") && handle(event);
    stage.addEventListener(
      "pointerdown",
      onPicture((event) => this.#down(event)),
      true,
    );
    stage.addEventListener(
      "pointermove",
      onPicture((event) => this.#move(event)),
      true,
    );
    for (const end of /** @type {const} */ (["pointerup", "pointercancel"]))
      stage.addEventListener(
        end,
        onPicture((event) => this.#up(event)),
        true,
      );
    $("picture").addEventListener("pointerleave", () => this.#held || actions.aim(null));
    stage.addEventListener("wheel", (event) => this.#turnWheel(event), { capture: true, passive: false });
  }

  /** A stroke of its own, at a place. @param {Place} place */ async once(place) {
    const tool = this.actions.tool(0);
    if (tool) await this.actions.use(tool, place, ++this.#strokes);
  }

  /** @param {PointerEvent} event */ #down(event) {
    const tool = this.actions.tool(event.button);
    if (!tool) return;
    const place = placeOf(event);
    if (event.pointerType === "touch") {
      const isFirst = this.gestures.pointers.size === 0;
      this.#lift();
      if (isFirst)
        this.#finger = { ...place, id: event.pointerId, timer: setTimeout(() => this.#rest(event, tool), FIRST) };
    } else if (event.altKey) {
      event.stopPropagation();
      this.actions.take(place);
    } else if (event.button === 1) {
      this.#middle = place;
    } else if (this.actions.locked() || (!event.shiftKey && !event.ctrlKey && !event.metaKey)) {
      event.stopPropagation(); // Shift runs, where the mouse is locked
      $("picture").focus();
      capture($("picture"), event.pointerId);
      this.#begin(event, tool);
    }
  }

  /** A finger that rests works as a held button. @param {PointerEvent} event @param {Tool} tool */ #rest(event, tool) {
    this.#finger = null;
    this.gestures.pointers.delete(event.pointerId);
    navigator.vibrate?.(12);
    this.#begin(event, tool);
  }

  #lift() {
    clearTimeout(this.#finger?.timer);
    this.#finger = null;
  }

  /** @param {PointerEvent} event @param {Tool} tool */ #begin(event, tool) {
    const place = placeOf(event);
    this.#held = { ...place, id: event.pointerId, event, tool, stroke: ++this.#strokes, acts: 0, last: place };
    this.#act();
  }

  /** @returns {Promise<void>} */ async #act() {
    const held = this.#held;
    if (!held || this.#isActing) return;
    clearTimeout(this.#timer);
    this.#isActing = true;
    held.last = { x: held.x, y: held.y };
    const done = await this.actions.use(held.tool, held.last, held.stroke);
    this.#isActing = false;
    if (this.#held !== held) return this.#act();
    if (!done?.hit && held.acts === 0) return this.#turn(held);
    held.acts++;
    this.#timer = setTimeout(() => this.#act(), held.acts === 1 ? FIRST : AGAIN);
  }

  /** A press beside the scene moves the camera. @param {Held} held */ #turn({ event, x, y }) {
    this.#held = null;
    if (this.actions.locked()) return;
    this.gestures.begin(event);
    Object.assign(this.gestures.pointers.get(event.pointerId) ?? {}, { x, y, pans: event.button === 2 });
  }

  /** @param {PointerEvent} event */ #move(event) {
    const place = placeOf(event);
    if (this.#finger && far(this.#finger, place) > TAP) this.#lift();
    if (this.#held?.id === event.pointerId) {
      Object.assign(this.#held, place);
      if (this.#held.acts && far(this.#held.last, place) > FARTHER) this.#act();
    }
    if (event.pointerType !== "touch" && this.actions.tool(0)) this.actions.aim(place);
  }

  /** @param {PointerEvent} event */ #up(event) {
    if (this.#held?.id === event.pointerId) {
      this.#held = null;
      clearTimeout(this.#timer);
    }
    if (this.#finger?.id === event.pointerId) {
      this.#lift();
      if (event.type === "pointerup") this.once(placeOf(event));
    }
    if (event.button !== 1 || !this.#middle) return;
    if (far(this.#middle, placeOf(event)) <= TAP) this.actions.take(placeOf(event));
    this.#middle = null;
  }

  /** @param {WheelEvent} event */ #turnWheel(event) {
    if (event.ctrlKey || event.shiftKey || !this.actions.tool(0) || event.target !== $("picture")) return;
    event.preventDefault();
    event.stopPropagation();
    this.#wheel += event.deltaY * (event.deltaMode ? NOTCH : 1);
    const steps = Math.trunc(this.#wheel / NOTCH);
    this.#wheel -= steps * NOTCH;
    if (steps) this.actions.nextMaterial(Math.sign(steps));
  }
}

/** @param {MouseEvent} event @returns {Place} */ const placeOf = ({ clientX, clientY }) => ({
  x: clientX,
  y: clientY,
});
/** @param {Place} a @param {Place} b */ const far = (a, b) => Math.hypot(a.x - b.x, a.y - b.y);
