// Mouse, touch, keys and gamepads move the camera of a page with a picture and a pad.

import { measure } from "./camera.js";
import { $, isPressed, pressed } from "./elements.js";
import { Flight } from "./flight.js";
import { Gestures } from "./gestures.js";
import { dolly, fly, look, orbit, pan } from "./navigation.js";
import { scale } from "./vectors.js";

const flies = () => isPressed($("fly"));
const mirrored = (of) => [of.flipX ? -1 : 1, of.flipY ? -1 : 1];

// `app` has change(how), limit() and side(); `commands` are functions by the code of a key; focus(x, y) is for a double
// click at a place of the page. Returns {gestures, flight}, whose step() is called once per frame of the screen.
export function makePilot(app, canvas, commands, focus) {
  const across = () => measure([canvas.clientWidth, canvas.clientHeight]);
  const gestures = new Gestures(canvas, {
    turn: (right, down) =>
      app.change((now) => {
        // pixels of the page: the scene follows the pointer
        const [x, y] = mirrored(now);
        const angle = flies() ? (now.fov * Math.PI) / 180 / across() : (2 * Math.PI) / canvas.clientHeight;
        return flies()
          ? look(now, -right * angle * x, down * angle * y)
          : orbit(now, right * angle * x, down * angle * y);
      }),
    pan: (right, down) =>
      app.change((now) => {
        const [x, y] = mirrored(now);
        return pan(now, (right * x) / across(), (down * y) / across(), app.limit());
      }),
    dolly: (factor) => app.change((now) => dolly(now, factor, app.limit())),
    focus,
  });
  const flight = new Flight($("pad"), {
    commands,
    fly: (...parts) =>
      app.change((now) => {
        const [x, y] = mirrored(now);
        return fly(now, scale([parts[0] * x, parts[1] * y, parts[2]], app.side()), app.limit());
      }),
    rotate: (right, up) =>
      app.change((now) =>
        flies()
          ? look(now, right * mirrored(now)[0], up * mirrored(now)[1])
          : orbit(now, -right * mirrored(now)[0], -up * mirrored(now)[1]),
      ),
    dolly: (factor) => app.change((now) => dolly(now, factor, app.limit())),
  });
  $("fly").onclick = () => setFlying(true);
  $("orbit").onclick = () => setFlying(false);
  return { gestures, flight };
}

function setFlying(on) {
  pressed($("fly"), on);
  pressed($("orbit"), !on);
  $("pad").hidden = !on || !matchMedia("(pointer: coarse)").matches;
}
