// The frames of USD prims: all of UsdGeom's transform operations, without what decomposition into position, turn and scale
// would lose.

import { Matrix4, Quaternion, Vector3 } from "../three/three.core.js";
/** @import { Attributes, Fields, Found, Numbers } from "./stage.js" */
/** @import { Composer, MethodsOf } from "./three_private.js" @import { Warn } from "../voxrt/warnings.js" */

const UNRELATED = "transforms that do not follow those above them are not read here; voxrt build reads them";
/** @type {Record<string, [number, number, number]>} */ const AXES = { X: [1, 0, 0], Y: [0, 1, 0], Z: [0, 0, 1] };

/** @param {Found} found @returns {MethodsOf<Composer>} */ export const frameMethods = (found) => () => ({
  applyTransform(object, fields, attributes = {}) {
    const data = /** @type {Attributes} */ ({ ...fields, ...attributes });
    /** @type {string[]} */
    const order = typeof data.xformOpOrder === "string" ? [] : Array.from(data.xformOpOrder ?? []);
    const reset = order.lastIndexOf("!resetXformStack!");
    if (reset >= 0) found.warn("transform", UNRELATED);
    object.matrixAutoUpdate = false;
    object.matrix.identity();
    for (const name of order.slice(reset + 1).reverse()) {
      const inverse = name.startsWith("!invert!");
      const matrix = operation(inverse ? name.slice("!invert!".length) : name, data, found);
      object.matrix.premultiply(inverse ? matrix.invert() : matrix);
    }
    object.matrix.decompose(object.position, object.quaternion, object.scale);
  },
  // The loader gives a lone mesh below a reference the frame of the prim that refers to it, and drops its own.
  _findSingleMesh: () => null,
});

/** @param {string} name @param {Attributes} data @param {Found} found */ function operation(name, data, found) {
  const value = data[name];
  const [, kind = ""] = /^xformOp:(\w+)/.exec(name) ?? [];
  if (!name || value === undefined || value === null) return new Matrix4();
  const [x, y, z] = typeof value === "number" ? [value, value, value] : value;
  if (kind === "translate") return new Matrix4().makeTranslation(x, y, z);
  if (kind === "scale") return new Matrix4().makeScale(x, y, z);
  if (kind === "transform" && value.length === 16) return new Matrix4().fromArray(value);
  if (kind === "orient" && value.length === 4) return turnBy(value);
  const [, turns = ""] = /^rotate([XYZ]{1,3})$/.exec(kind) ?? [];
  if (turns.length === 1) return turnAbout(turns, x);
  const degrees = (/** @type {string} */ axis) => [x, y, z]["XYZ".indexOf(axis)];
  if (turns.length === 3)
    return [...turns].reduce((made, axis) => made.premultiply(turnAbout(axis, degrees(axis))), new Matrix4());
  const lone = /^(translate|scale)([XYZ])$/.exec(kind);
  if (lone) {
    const rest = lone[1] === "scale" ? 1 : 0;
    const [a, b, c] = ["X", "Y", "Z"].map((axis) => (axis === lone[2] ? x : rest));
    return rest ? new Matrix4().makeScale(a, b, c) : new Matrix4().makeTranslation(a, b, c);
  }
  found.warn("transform", `transforms ${name} are not read here; voxrt build reads them`);
  return new Matrix4();
}

/** @param {string} axis @param {number} degrees */ const turnAbout = (axis, degrees) =>
  turn(new Quaternion().setFromAxisAngle(new Vector3(...AXES[axis]), (degrees * Math.PI) / 180).normalize());

/** A turn by the angle of the real part about the axis of the others, of any length. @param {Numbers} parts */
function turnBy([x, y, z, w]) {
  const axis = new Vector3(x, y, z);
  if (axis.length() < 1e-6) return new Matrix4();
  const angle = 2 * Math.acos(Math.min(Math.max(w, -1), 1));
  return turn(new Quaternion().setFromAxisAngle(axis.normalize(), angle).normalize());
}

/** The matrix as OpenUSD computes it, so that quarter turns round alike. @param {Quaternion} quaternion */
function turn({ x, y, z, w }) {
  // biome-ignore format: a matrix by rows
  return new Matrix4().set(
    1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (z * x + y * w), 0,
    2 * (x * y + z * w), 1 - 2 * (z * z + x * x), 2 * (y * z - x * w), 0,
    2 * (z * x - y * w), 2 * (y * z + x * w), 1 - 2 * (y * y + x * x), 0,
    0, 0, 0, 1,
  );
}

/** @type {Record<string, number[]>} */
const UPWARDS = { X: [0, -1, 0, 1, 0, 0, 0, 0, 1], Y: [1, 0, 0, 0, 1, 0, 0, 0, 1], Z: [1, 0, 0, 0, 0, 1, 0, -1, 0] };

/** The rotation of a stage to y up and metres, 9 numbers by rows. @param {Fields} fields @param {Warn} warn */
export function sceneFrame({ upAxis = "Y", metersPerUnit = 0.01 }, warn) {
  const axis = String(upAxis).toUpperCase();
  if (!(axis in UPWARDS)) warn("up-axis", `upAxis '${upAxis}' is not X, Y or Z; Y was used`);
  if (!(Number.isFinite(metersPerUnit) && metersPerUnit > 0))
    throw new Error(`metersPerUnit ${metersPerUnit} is not a positive number; set it to the metres per unit`);
  return (UPWARDS[axis] ?? UPWARDS.Y).map((part) => part * metersPerUnit);
}

/** A transform of 3 rows of 4 in that frame. @param {number[]} frame @param {ArrayLike<number>} rows */
export const framed = (frame, rows) =>
  Array.from({ length: 12 }, (_, at) => {
    const [row, column] = [at >> 2, at & 3];
    return [0, 1, 2].reduce((sum, i) => sum + frame[3 * row + i] * rows[4 * i + column], 0);
  });
