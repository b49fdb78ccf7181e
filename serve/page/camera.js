// The camera of the page (eye, yaw, pitch, field of view), and its conversion from and to the camera registers:
// direction(column, row) = look + right * (column - W/2) + up * (H/2 - row), with right = look x up in a right-handed grid.
// The registers get the largest integers whose directions stay below 2**20.

const REGISTER_LIMIT = 32767;
const DIRECTION_LIMIT = (1 << 20) - 1;
export const FIELD_OF_VIEW = { min: 5, max: 140, usual: 35 };

const add = (a, b, factor = 1) => a.map((value, axis) => value + b[axis] * factor);
const dot = (a, b) => a.reduce((sum, value, axis) => sum + value * b[axis], 0);
export const length = (a) => Math.hypot(...a);
const scale = (a, factor) => a.map((value) => value * factor);
const clamp = (value, low, high) => Math.min(high, Math.max(low, value));

// A pose: eye in voxels; yaw and pitch in radians, both 0 for a look along -z; fov in degrees across the shorter side of
// the frame; flips mirror the picture.
export const pose = (eye, yaw, pitch, fov, flipX = false, flipY = false) => ({ eye, yaw, pitch, fov, flipX, flipY });

export function axes({ yaw, pitch }) {
  const [sy, cy, sp, cp] = [Math.sin(yaw), Math.cos(yaw), Math.sin(pitch), Math.cos(pitch)];
  return { look: [cp * sy, sp, -cp * cy], right: [cy, 0, sy], up: [-sp * sy, cp, sp * cy] };
}

export const focal = (fov, [width, height]) => Math.min(width, height) / (2 * Math.tan((fov * Math.PI) / 360));
export const fieldOfView = (distance, [width, height]) => (Math.atan(Math.min(width, height) / 2 / distance) * 360) / Math.PI;

export function toRegisters(view, size) {
  const { look, right, up } = axes(view);
  const halves = size.map((side) => Math.floor(side / 2));
  const ahead = scale(look, focal(view.fov, size));
  const rounding = 1 + halves[0] + halves[1];
  const reach = Math.max(...[0, 1, 2].map((axis) =>
    Math.abs(ahead[axis]) + Math.abs(right[axis]) * halves[0] + Math.abs(up[axis]) * halves[1]));
  const largest = Math.max(...[...ahead, ...right, ...up].map(Math.abs));
  const factor = Math.min(REGISTER_LIMIT / largest, (DIRECTION_LIMIT - rounding) / reach);
  const whole = (triple, sign = 1) => triple.map((value) => Math.round(value * factor * sign) + 0);
  return {
    position: view.eye.map((value) => Math.round(value * 16)),
    look: whole(ahead),
    right: whole(right, view.flipX ? -1 : 1),
    up: whole(up, view.flipY ? -1 : 1),
  };
}

export function fromRegisters({ position, look, right, up }, size) {
  const ahead = scale(look, 1 / (length(look) || 1));
  const pitch = Math.asin(clamp(ahead[1], -1, 1));
  // A look straight up or down has no yaw; then right gives it.
  const level = Math.hypot(look[0], look[2]) > 1e-6 * length(look);
  let yaw = level ? Math.atan2(ahead[0], -ahead[2]) : Math.atan2(right[2], right[0]);
  const upright = axes({ yaw, pitch });
  return pose(
    position.map((value) => value / 16), yaw, pitch,
    clamp(fieldOfView(length(look) / (length(right) || 1), size), FIELD_OF_VIEW.min, FIELD_OF_VIEW.max),
    dot(upright.right, right) < 0, dot(upright.up, up) < 0,
  );
}

export function turn(view, right, up) {
  return { ...view, yaw: view.yaw + right, pitch: clamp(view.pitch + up, -Math.PI / 2, Math.PI / 2) };
}

// Move in voxels: to the right of the view, up in the world, forward in the view.
export function move(view, [sideways, upwards, forwards], limit) {
  const { look, right } = axes(view);
  const eye = add(add(add(view.eye, right, sideways), [0, 1, 0], upwards), look, forwards);
  return { ...view, eye: eye.map((value) => clamp(value, -limit, limit)) };
}

export function zoom(view, factor) {
  return { ...view, fov: clamp(view.fov * factor, FIELD_OF_VIEW.min, FIELD_OF_VIEW.max) };
}

export function lookAlong(view, direction) {
  const size = length(direction);
  if (size < 1e-9) return view;
  const [x, y, z] = scale(direction, 1 / size);
  return { ...view, yaw: Math.hypot(x, z) > 1e-9 ? Math.atan2(x, -z) : view.yaw, pitch: Math.asin(clamp(y, -1, 1)) };
}

// A view from outside along `direction` that shows a whole world of `side` voxels per side.
export function faceWorld(side, direction, fov = FIELD_OF_VIEW.usual) {
  const straight = direction.filter((value) => value !== 0).length === 1;
  const radius = straight ? side * 0.5 : side * Math.sqrt(3) * 0.5;
  const half = (fov * Math.PI) / 360;
  const away = straight ? radius / Math.tan(half) * 1.1 + radius : radius / Math.sin(half);
  const start = lookAlong(pose([0, 0, 0], 0, 0, fov), direction);
  return { ...start, eye: add([side / 2, side / 2, side / 2], axes(start).look, -away) };
}
