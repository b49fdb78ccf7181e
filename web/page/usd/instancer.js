// Point instancers of USD: copies of their prototypes, which three.js' loader shows in their own place alone.

import { fieldsOf, isShown, targetsOf } from "./stage.js";
import { Matrix4, Object3D, Quaternion, Vector3 } from "../three/three.core.js";
/** @import { Attributes, Found, Numbers } from "./stage.js" */
/** @import { Composer, MethodsOf } from "./three_private.js" */

/** @typedef {(problem: string) => never} Refuse */
const AGAIN = "export the instancer again";
const OTHERS = "have other lengths";

/** @param {Found} found @returns {MethodsOf<Composer>} */ export const instancerMethods = (found) => (kept) => ({
  _buildHierarchy(parent, path) {
    if (this.specsByPath[path]?.fields?.typeName === "PointInstancer") placeCopies(this, parent, path, found);
    else kept._buildHierarchy.call(this, parent, path);
  },
});

/** Put the copies of the instancer at `path` into `object`, which stands in its place. @param {Composer} composer
 * @param {Object3D} object @param {string} path @param {Found} found */
function placeCopies(composer, object, path, found) {
  /** @type {Refuse} */ const refuse = (problem) => {
    throw new Error(`${path}: ${problem}`);
  };
  const attributes = composer._getAttributes(path);
  const { protoIndices = [], positions = [], scales = [] } = /** @type {Record<string, Numbers>} */ (attributes);
  const names = targetsOf(fieldsOf(composer, path, "prototypes")?.targetPaths, path);
  const wrong = protoIndices.findIndex((index) => !names[index]);
  if (wrong >= 0)
    refuse(`protoIndices[${wrong}] is ${protoIndices[wrong]} and there are ${names.length} prototypes; ${AGAIN}`);
  const absent = names.find((name) => !composer.specsByPath[name]);
  if (absent) refuse(`prototype ${absent} does not exist; repair its prototypes`);
  if (found.open.has(path)) refuse("the point instancer copies itself; repair its prototypes");
  found.open.add(path);
  const used = new Set(protoIndices);
  const prototypes = names.map((name, index) => (used.has(index) ? built(composer, name, found) : null));
  found.open.delete(path);
  const count = protoIndices.length;
  const turns = turnsOf(/** @type {Record<string, Numbers>} */ (attributes));
  /** @param {ArrayLike<number>} values @param {number} size */
  const fits = (values, size) => values.length === 0 || values.length === size * count;
  if (positions.length !== 3 * count || !fits(turns, 4) || !fits(scales, 3))
    refuse(`protoIndices has ${count} entries and the positions, orientations or scales ${OTHERS}; ${AGAIN}`);
  const hidden = hiddenOf(composer, path, attributes, count, refuse, found);
  found.warn("invisible", "masked copies of point instancers were left out", hidden.size);
  const sizes = prototypes.map(objectsOf);
  const objects = Array.from(protoIndices).reduce((sum, index) => sum + 1 + sizes[index], 0);
  found.charge(path, objects);
  for (let i = 0; i < count; i++) {
    const prototype = prototypes[protoIndices[i]];
    if (hidden.has(i) || !prototype) continue;
    const copy = new Object3D();
    copy.name = `${object.name}[${i}]`;
    copy.userData.copies = true;
    copy.matrixAutoUpdate = false;
    const scale = scales.length ? new Vector3().fromArray(scales, 3 * i) : new Vector3(1, 1, 1);
    const turn = turns.length ? new Quaternion().fromArray(turns, 4 * i) : new Quaternion();
    copy.matrix.copy(new Matrix4().compose(new Vector3().fromArray(single(positions), 3 * i), turn, scale));
    copy.add(prototype.clone());
    object.add(copy);
  }
}

/** The object of a prim; null if it is hidden. @param {Composer} composer @param {string} path @param {Found} found */
function built(composer, path, found) {
  if (!isShown(composer, path, found, true)) return null;
  const parent = new Object3D();
  const alone = `${path} alone`; // a parent that has this child only
  composer.childrenByPath.set(alone, [{ name: path.slice(path.lastIndexOf("/") + 1), path }]);
  composer._buildHierarchy(parent, alone);
  return parent.children[0] ?? null;
}

/** The copies of instancers below a prototype are copied again, and count. @param {Object3D | null} prototype */
function objectsOf(prototype) {
  let count = 0;
  prototype?.traverse(() => count++);
  return count;
}

/** @param {Numbers} values */
const single = (values) => (values instanceof Float32Array ? values : Float32Array.from(values));

/** Four numbers per copy: x, y, z, w, of any length, as USD takes them. Files of text have more digits than the
 * values that they stand for. @param {Record<string, Numbers | undefined>} attributes */
const turnsOf = ({ orientationsf = [], orientations = [] }) =>
  orientationsf.length ? single(orientationsf) : Float64Array.from(orientations, half);

/** @param {number} value */ function half(value) {
  if (value === 0) return 0;
  const step = 2 ** (Math.max(Math.floor(Math.log2(Math.abs(value))), -14) - 10);
  const steps = Math.abs(value) / step;
  const [low, part] = [Math.floor(steps), steps - Math.floor(steps)];
  return Math.sign(value) * step * (part > 0.5 || (part === 0.5 && low % 2) ? low + 1 : low);
}

/** The copies that are masked. @param {Composer} composer @param {string} path @param {Attributes} attributes @param
 * {number} count @param {Refuse} refuse @param {Found} found */
function hiddenOf(composer, path, attributes, count, refuse, found) {
  const { ids = [], invisibleIds = [] } = /** @type {Record<string, Numbers>} */ (attributes);
  /** @param {string} name */ const has = (name) => composer.specsByPath[`${path}.${name}`];
  if (composer.specsByPath[path].fields.inactiveIds !== undefined)
    refuse("copies that are not active are not read here; voxrt build reads them");
  // The loader leaves long arrays of 64 bits in binary files empty.
  if (has("invisibleIds") && !invisibleIds.length)
    found.warn("instancer", "masks of point instancers that cannot be read here were not used; voxrt build uses them");
  if (invisibleIds.length && has("ids") && ids.length !== count)
    refuse(`ids has ${ids.length} entries and there are ${count} copies; ${AGAIN}`);
  const masked = new Set(Array.from(invisibleIds, Number));
  return new Set(Array.from({ length: count }, (_, i) => i).filter((i) => masked.has(Number(ids.length ? ids[i] : i))));
}
