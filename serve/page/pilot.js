// Mouse, touch, keys and gamepads move the camera of a page with a picture and a pad.

import { measure } from "./camera.js";
import { $, isPressed, pressed } from "./elements.js";
import { Flight } from "./flight.js";
import { Gestures } from "./gestures.js";
import { dolly, fly, look, orbit, pan } from "./navigation.js";
import { scale } from "./vectors.js";
/** @import { Box, Pose, Size } from "./camera.js" @import { Commands } from "./tools.js" */
/** @import { Move } from "./viewpoint.js" */

/** What controls of the camera ask of a page; places are in voxels. `size`: of the picture; `side`: of the world;
 * `bounds`: of what is solid; `limit`: of the eye's coordinates. @typedef {{ view: () => Pose | null, size: () =>
 * Size, side: () => number, bounds: () => Box, limit: () => number, change: (how: Move) => void, glide: (how: Move)
 * => void }} Page */

const MODES = /** @type {const} */ (["orbit", "fly", "walk"]);
/** Whether somebody walks, by foot alone: walker.js. */
const walks = () => Boolean($("walk") && isPressed($("walk")));
/** Whether turns are those of the eye. */ const flies = () => !isPressed($("orbit"));
/** @param {Pose} view */ const mirrored = ({ flipX, flipY }) => [flipX ? -1 : 1, flipY ? -1 : 1];

/** `focus` is for a double click at a place of the page. Returns what has a step() for each frame of the screen.
 * @param {Page} app @param {HTMLCanvasElement} canvas @param {Commands} commands @param {(x: number, y: number) =>
 * void} focus */
export function makePilot(app, canvas, commands, focus) {
  /** @param {Move} how */ const go = (how) => walks() || app.change(how);
  /** @param {number} factor */ const approach = (factor) => go((now) => dolly(now, factor, app.limit()));
  const across = () => measure([canvas.clientWidth, canvas.clientHeight]);
  const gestures = new Gestures(canvas, {
    turn: (right, down) =>
      app.change((now) => {
        const [x, y] = mirrored(now);
        const angle = flies() ? (now.fov * Math.PI) / 180 / across() : (2 * Math.PI) / canvas.clientHeight;
        return flies()
          ? look(now, -right * angle * x, down * angle * y)
          : orbit(now, right * angle * x, down * angle * y);
      }),
    pan: (right, down) =>
      go((now) => {
        const [x, y] = mirrored(now);
        return pan(now, (right * x) / across(), (down * y) / across(), app.limit());
      }),
    dolly: approach,
    focus,
  });
  const flight = new Flight($("pad"), {
    commands,
    fly: (right, up, forward) =>
      go((now) => {
        const [x, y] = mirrored(now);
        return fly(now, scale([right * x, up * y, forward], app.side()), app.limit());
      }),
    rotate: (right, up) =>
      app.change((now) =>
        flies()
          ? look(now, right * mirrored(now)[0], up * mirrored(now)[1])
          : orbit(now, -right * mirrored(now)[0], -up * mirrored(now)[1]),
      ),
    dolly: approach,
  });
  $("fly").onclick = () => setMode("fly");
  $("orbit").onclick = () => setMode("orbit");
  return { gestures, flight };
}

/** @param {typeof MODES[number]} mode */ export function setMode(mode) {
  for (const one of MODES) if ($(one)) pressed($(one), one === mode);
  $("pad").hidden = mode === "orbit" || !matchMedia("(pointer: coarse)").matches;
}
