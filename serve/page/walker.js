// "Walk": the eye of somebody who stands in the scene. Keys and the pad walk, dragging looks around; a click locks the
// mouse, as in games, until Escape.

import { pixelDirection } from "./camera.js";
import { $, isPressed } from "./elements.js";
import { look } from "./navigation.js";
import { notice } from "./notices.js";
import { setMode } from "./pilot.js";
import { bodyBox, bodyFor, eyeOf, roomAbove, step } from "./walk.js";
/** @import { Box, Pose, Registers, Size } from "./camera.js" @import { Flight } from "./flight.js" */
/** @import { Page } from "./pilot.js" @import { Vector } from "./vectors.js" @import { Body, Walk } from "./walk.js" */

/** The voxels to walk on. `scene`: another value for another scene; null for none. `voxelSize`: metres, where that is
 * known; `tallest`: most voxels to the eye. `meets`: whether a box overlaps a solid voxel, once it was prepared; later
 * also near the boxes before. `hit`: the first solid voxel on a ray, and the axis of its face. @typedef {{ scene:
 * unknown, voxelSize: number | null, tallest: number, prepare: (box: Box) => Promise<void>, meets: (low: Vector, high:
 * Vector) => boolean, hit: (origin: Vector, direction: Vector) => Promise<{ cell: Vector | null, face: number | null
 * }> }} Ground */

/** @typedef {Page & { frames: { registers: (pose: Pose, size: Size) => Registers }, walker: unknown }} WalkedPage */

const FIELD_OF_VIEW = 60;
const RUN = 1.8; // times the pace
const TURN = 0.002; // radians per pixel of a locked mouse, as three.js has it
const UPWARDS = 1; // the axis
const ROWS = [0.7, 0.65, 0.75, 0.6, 0.8, 0.55, 0.85, 0.5, 0.4, 0.3]; // parts of the picture's height
const NO_WAY = "One cannot walk here";
const REACH = 6; // heights of the eye to what the camera orbits later

export class Walker {
  /** @type {{ walk: Walk, body: Body, fov: number } | null} */ #state = null;
  #last = 0;
  #hasLocked = false;
  #lockFails = !matchMedia("(pointer: fine)").matches;

  /** @param {WalkedPage} app @param {Flight} flight @param {Ground} ground */ constructor(app, flight, ground) {
    this.app = app;
    this.flight = flight;
    this.ground = ground;
    app.walker = this;
    flight.walker = this;
    const canvas = $("picture");
    canvas.addEventListener("click", async () => {
      if (!this.takesPress()) return;
      try {
        await canvas.requestPointerLock();
      } catch {
        this.#lockFails = !this.#hasLocked; // a moment after Escape it does, too
      }
    });
    document.addEventListener("pointerlockchange", () => {
      this.#hasLocked ||= this.locked;
      document.body.classList.toggle("locked", this.locked);
    });
    document.addEventListener("mousemove", ({ movementX, movementY }) => {
      if (!this.locked || !this.#state) return;
      this.app.change((now) => look(now, movementX * TURN, -movementY * TURN));
    });
  }

  /** Whether the mouse has no pointer and looks around. */
  get locked() {
    return document.pointerLockElement === $("picture");
  }

  /** Whether a press of the mouse locks it, and does nothing else. */
  takesPress = () => this.#state !== null && !this.locked && !this.#lockFails;

  /** Whether the body moves by itself. */
  get active() {
    return this.#state !== null && !this.#state.walk.stands;
  }

  /** Where the body is; null for nobody. @returns {Box | null} */
  box = () => this.#state && bodyBox(this.#state.walk.place, this.#state.body);

  /** Whether a box is in the walls of the world, or in its floor. @param {Vector} low @param {Vector} high */
  #isOutside = (low, high) => Math.min(...low) < 0 || Math.max(high[0], high[2]) > this.app.side();

  /** @param {Vector} low @param {Vector} high */
  #meets = (low, high) => this.#isOutside(low, high) || this.ground.meets(low, high);

  /** Stand where the eye is, if it has room in the world; else on ground below the middle of the picture. */
  async start() {
    const [{ scene, voxelSize, tallest }, pose] = [this.ground, this.app.view()];
    if (scene === null || !pose) return;
    const body = bodyFor(voxelSize, this.app.side(), tallest);
    const place = await this.#landing(pose, body).catch(({ message }) => notice("error", NO_WAY, message));
    if (!place || this.ground.scene !== scene) return;
    setMode("walk");
    $("picture").focus();
    this.#state = { walk: { place, rise: 0, stands: false, lag: 0 }, body, fov: this.#state?.fov ?? pose.fov };
    this.#last = performance.now();
    const eye = eyeOf(this.#state.walk, body);
    this.app.change((now) => ({ ...now, eye, pitch: now.pitch / 4, fov: FIELD_OF_VIEW, distance: REACH * body.eye }));
  }

  /** @param {Pose} pose @param {Body} body */ async #landing(pose, body) {
    const side = this.app.side();
    const soles = [pose.eye[0], pose.eye[1] - body.eye, pose.eye[2]];
    const box = bodyBox(soles, body);
    if (pose.eye[1] < side && !this.#isOutside(...box)) {
      await this.ground.prepare(box);
      if (!this.ground.meets(...box)) return soles;
    }
    const size = this.app.size();
    const registers = this.app.frames.registers(pose, size);
    const inside = (/** @type {number} */ at) => Math.min(side - body.radius, Math.max(body.radius, at + 0.5));
    const ways = ROWS.map((row) => pixelDirection(registers, size, size[0] >> 1, Math.floor(row * size[1])));
    const hits = await Promise.all(ways.map((way) => this.ground.hit(registers.position, way)));
    for (const [i, { cell, face }] of hits.entries()) {
      if (!cell || face !== UPWARDS || ways[i][UPWARDS] > 0) continue;
      const place = [inside(cell[0]), cell[1] + 1, inside(cell[2])];
      const room = await this.#room(place, body, place[1] + body.step);
      if (room) return room;
    }
    const [low, high] = this.app.bounds();
    const middle = [(low[0] + high[0]) / 2, high[1], (low[2] + high[2]) / 2];
    const above = middle.map((at, axis) => (axis === UPWARDS ? at : inside(at)));
    return this.#room(above, body, side);
  }

  /** @param {Vector} place @param {Body} body @param {number} top */ async #room(place, body, top) {
    const [low, [x, y, z]] = bodyBox(place, body);
    await this.ground.prepare([low, [x, y + Math.max(0, top - place[UPWARDS]) + 1, z]]);
    return roomAbove(place, body, top, this.#meets);
  }

  /** The ground is not known any more. @param {string} problem */ fail(problem) {
    this.end();
    notice("error", NO_WAY, problem);
  }

  /** Called once per frame of the screen. */
  step() {
    if (!this.#state) return;
    if (!isPressed($("walk")) || !this.app.view()) return this.end();
    const now = performance.now();
    const seconds = (now - this.#last) / 1000;
    this.#last = now;
    const { walk, body } = this.#state;
    const [right, up, forward] = this.flight.going();
    const wish = { right, forward, yaw: this.app.view()?.yaw ?? 0, jump: up > 0, pace: this.flight.fast ? RUN : 1 };
    const next = step(walk, body, wish, seconds, this.#meets);
    const [eye, before] = [eyeOf(next, body), eyeOf(walk, body)];
    this.#state = { ...this.#state, walk: next };
    if (eye.some((part, axis) => Math.abs(part - before[axis]) > 1e-4)) this.app.change((pose) => ({ ...pose, eye }));
  }

  /** Another way of moving begins, or another memory comes. */
  end() {
    if (!this.#state) return;
    const { fov } = this.#state;
    this.#state = null;
    if (this.locked) document.exitPointerLock();
    if (isPressed($("walk"))) setMode("orbit");
    this.app.change((now) => ({ ...now, fov }));
  }
}
