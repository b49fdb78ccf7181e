// "Walk": the eye of somebody who stands in the scene. Keys and the pad walk, dragging looks around; a click locks the
// mouse, as in games, until Escape.

import { pixelDirection } from "./camera.js";
import { $, isPressed } from "./elements.js";
import { look } from "./navigation.js";
import { setMode } from "./pilot.js";
import { meetsSolid } from "./solids.js";
import { bodyBox, bodyFor, eyeOf, roomAbove, step } from "./walk.js";
/** @import { App } from "./app.js" @import { Box, Pose } from "./camera.js" @import { Editor } from "./editor.js" */
/** @import { Flight } from "./flight.js" @import { Body, Meets, Walk } from "./walk.js" */

const FIELD_OF_VIEW = 60;
const RUN = 1.8; // times the pace
const TURN = 0.002; // radians per pixel of a locked mouse, as three.js has it
const UPWARDS = 1; // the axis
const ROWS = [0.7, 0.65, 0.75, 0.6, 0.8, 0.55, 0.85, 0.5, 0.4, 0.3]; // parts of the picture's height
const REACH = 6; // heights of the eye to what the camera orbits later

export class Walker {
  /** @type {{ walk: Walk, body: Body, fov: number } | null} */ #state = null;
  /** @type {Editor | null} */ #editor = null;
  #last = 0;
  #hasLocked = false;
  #lockFails = !matchMedia("(pointer: fine)").matches;

  /** @param {App} app @param {Flight} flight */ constructor(app, flight) {
    this.app = app;
    this.flight = flight;
    app.walker = this;
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

  /** The voxels of an editor are those that are met. @param {Editor | null} editor */ follow(editor) {
    this.#editor = editor;
  }

  /** Where the body is; null for nobody. @returns {Box | null} */
  box = () => this.#state && bodyBox(this.#state.walk.place, this.#state.body);

  /** The walls of the world and its floor are solid. @returns {Meets} */ #meets() {
    const memory = this.app.memory();
    if (!memory) return () => false;
    const { words, depth } = memory;
    const octree = this.#editor?.words ?? { words, depth, root: words[0] };
    const side = 2 ** depth;
    return (low, high) =>
      low[1] < 0 || Math.min(low[0], low[2]) < 0 || Math.max(high[0], high[2]) > side || meetsSolid(octree, low, high);
  }

  /** Stand where the eye is, if it has room in the world; else on ground below the middle of the picture. */
  async start() {
    const [memory, pose] = [this.app.memory(), this.app.view()];
    if (!memory || !pose) return;
    const body = bodyFor(memory.grid?.voxelSize ?? null, this.app.side());
    const place = await this.#landing(pose, body);
    if (!place || this.app.memory() !== memory) return;
    setMode("walk");
    $("picture").focus();
    this.#state = { walk: { place, rise: 0, stands: false, lag: 0 }, body, fov: this.#state?.fov ?? pose.fov };
    this.#last = performance.now();
    const eye = eyeOf(this.#state.walk, body);
    this.app.change((now) => ({ ...now, eye, pitch: now.pitch / 4, fov: FIELD_OF_VIEW, distance: REACH * body.eye }));
  }

  /** @param {Pose} pose @param {Body} body */ async #landing(pose, body) {
    const [side, meets] = [this.app.side(), this.#meets()];
    const soles = [pose.eye[0], pose.eye[1] - body.eye, pose.eye[2]];
    if (pose.eye[1] < side && !meets(...bodyBox(soles, body))) return soles;
    const size = this.app.size();
    const registers = this.app.frames.registers(pose, size);
    const inside = (/** @type {number} */ at) => Math.min(side - body.radius, Math.max(body.radius, at + 0.5));
    const ways = ROWS.map((row) => pixelDirection(registers, size, size[0] >> 1, Math.floor(row * size[1])));
    const hits = await Promise.all(ways.map((way) => this.app.painter.follow(registers.position, way)));
    for (const [i, { cell, face }] of hits.entries()) {
      if (!cell || face !== UPWARDS || ways[i][UPWARDS] > 0) continue;
      const place = [inside(cell[0]), cell[1] + 1, inside(cell[2])];
      const room = roomAbove(place, body, place[1] + body.step, meets);
      if (room) return room;
    }
    const [low, high] = this.app.bounds();
    const middle = [(low[0] + high[0]) / 2, high[1], (low[2] + high[2]) / 2];
    return roomAbove(
      middle.map((at, axis) => (axis === UPWARDS ? at : inside(at))),
      body,
      side,
      meets,
    );
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
    const next = step(walk, body, wish, seconds, this.#meets());
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
