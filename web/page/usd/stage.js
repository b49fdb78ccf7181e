// What a stage of USD says of its prims: values at its first moment, inherited bindings and primvars, which prims it shows.
// A prim is known by its path in a composer.

/** @import { Composer, MethodsOf } from "./three_private.js" @import { Warn } from "../voxrt/warnings.js" */

/** @typedef {number[] | Float32Array | Float64Array | Int32Array} Numbers */
/** @typedef {any} Value of an attribute: whatever a file holds */
/** @typedef {Record<string, Value>} Attributes by name */
/** @typedef {(composer: Composer, prim: string, name: string) => Value} Ask */
/** @typedef {string | string[]} List of paths or references; text has all of them as one */

/** The fields of a spec that are used. @typedef {{ typeName?: string, specifier?: number, active?: boolean,
 * default?: Value, timeSamples?: { times: Numbers, values: Value[] }, interpolation?: string, elementSize?: number,
 * targetPaths?: List, connectionPaths?: List, bindMaterialAs?: string, primChildren?: string[],
 * variantSetChildren?: string[], variantSelection?: Record<string, string>, apiSchemas?: string[], references?:
 * List, payload?: List, inheritPaths?: List, specializes?: List, subLayers?: List, defaultPrim?: string,
 * inactiveIds?: unknown, startTimeCode?: number, endTimeCode?: number, upAxis?: string, metersPerUnit?: number }}
 * Fields */

/** @typedef {{ specType: number, fields: Fields }} Spec */
/** @typedef {Record<string, Spec>} Specs by path */

/** What is known of the stage that is read. `fields`: of its root; `moment`: the time, null for the earliest;
 * `open`: instancers whose prototypes are built; `charge`: refuses too many prims; `layer`: the specs of a file
 * that was dropped together with the scene. @typedef {{ warn: Warn, fields: Fields, moment: number | null, open:
 * Set<string>, charge: (place: string, count: number) => void, layer: (file: string) => Specs | null }} Found */

/** @typedef {{ values: Numbers, size: number, interpolation: string }} Primvar `size`: numbers per value */

/** A prim and those above it, the nearest first. @param {string} path */
export function* upwards(path) {
  for (let at = path; at.length > 1; at = at.slice(0, Math.max(at.lastIndexOf("/"), 0))) yield at;
}

/** @type {(composer: Composer, prim: string, name: string) => Fields | null} */
export const fieldsOf = (composer, prim, name) => composer.specsByPath[`${prim}.${name}`]?.fields ?? null;

/** @type {Ask} */
export const attributeOf = (composer, prim, name) => composer._resolveAttributeValue(`${prim}.${name}`) ?? null;

/** An attribute that has numbers; null for none. @type {(composer: Composer, prim: string, name: string) => Numbers
 * | null} */
export const numbersOf = attributeOf;

/** An attribute that has names; empty for none. @type {(composer: Composer, prim: string, name: string) => string[]} */
export const namesOf = (composer, prim, name) => Array.from(attributeOf(composer, prim, name) ?? []);

/** The targets of a list. Text has it as one: "[/a/b, /a/c]". @param {List | undefined} paths @param {string} prim */
export function targetsOf(paths, prim) {
  const names = [paths ?? []]
    .flat()
    .join()
    .replace(/[[\]<>\s]/g, "")
    .split(",");
  const known = names.filter((name) => name && name !== "None");
  return known.map((name) => (name.startsWith("/") ? name : `${prim}/${name}`));
}

/** @param {Found} found @returns {MethodsOf<Composer>} */ export const stageMethods = (found) => (kept) => ({
  _buildIndexes() {
    kept._buildIndexes.call(this);
    for (const [parent, children] of this.childrenByPath) {
      const order = this.specsByPath[parent]?.fields.primChildren;
      const places = new Map(order ? Array.from(order, (name, i) => [name, i]) : []);
      const place = (/** @type {{ name: string }} */ { name }) => places.get(name) ?? Infinity;
      const sorted = places.size ? children.toSorted((a, b) => place(a) - place(b) || 0) : children;
      const shown = sorted.filter(({ path }) => isShown(this, path, found));
      this.childrenByPath.set(parent, shown);
    }
  },
  _resolveAttributeValue(path) {
    const fields = this.specsByPath[String(path).replace(/[<>]/g, "")]?.fields;
    if (!fields) return undefined;
    const { typeName = "", timeSamples } = fields;
    if (timeSamples?.times?.length)
      return singles(sampleOf(timeSamples.times, timeSamples.values, found.moment, typeName), typeName);
    fields.default = singles(fields.default, typeName);
    return fields.default;
  },
  _getVariantPaths: () => [], // references.js has chosen them
  _buildSkeleton: () => null,
  _buildAnimations: () => [],
});

const HELD = /^(u?int|bool|token|string|asset|uchar)/;

/** @type {(times: Numbers, values: Value[], moment: number | null, type: string) => Value} */
function sampleOf(times, values, moment, type) {
  if (moment === null) return values[0];
  const after = times.findIndex((time) => time >= moment);
  if (after < 0) return values.at(-1);
  if (after === 0 || times[after] === moment) return values[after];
  const [low, high] = [values[after - 1], values[after]];
  if (HELD.test(type) || low?.length !== high?.length || typeof low === "string") return low;
  const part = (moment - times[after - 1]) / (times[after] - times[after - 1]);
  const mixed = (/** @type {number} */ a, /** @type {number} */ b) => (1 - part) * a + part * b;
  return typeof low === "number" ? mixed(low, high) : Array.from(low, (one, i) => mixed(one, high[i]));
}

const OVER = 1;

/** Whether a prim and those below it are shown, as far as the prim decides it. Prototypes, and what is below a prim
 * that is not defined, need not be defined themselves. @param {Composer} composer @param {string} path @param
 * {Found} found */
export function isShown(composer, path, found, isPrototype = false) {
  const fields = composer.specsByPath[path]?.fields;
  if (!fields) return false;
  const { typeName, specifier = 0, active } = fields;
  const above = composer.specsByPath[path.slice(0, path.lastIndexOf("/"))]?.fields ?? {};
  const isBelow = above.typeName === "PointInstancer" || (above.specifier ?? 0) >= OVER;
  if (active === false || (specifier >= OVER && !isPrototype && !isBelow)) return false;
  if (!typeName) return true;
  if (attributeOf(composer, path, "visibility") === "invisible") {
    found.warn("invisible", "invisible prims and their descendants were left out");
    return false;
  }
  const purpose = attributeOf(composer, path, "purpose");
  if (purpose === null || purpose === "default" || purpose === "render") return true;
  found.warn("purpose", `prims of purpose ${purpose} and their descendants were left out`);
  return false;
}

const BINDINGS = ["material:binding:preview", "material:binding", "material:binding:full"];

/** The material of the nearest binding, unless one further up is stronger. @param {Composer} composer @param
 * {string} prim */
export function boundMaterial(composer, prim) {
  for (const name of BINDINGS) {
    let winner = null;
    for (const above of upwards(prim)) {
      const fields = fieldsOf(composer, above, name);
      const [target] = targetsOf(fields?.targetPaths, above);
      if (target && (winner === null || fields?.bindMaterialAs === "strongerThanDescendants")) winner = target;
    }
    if (winner !== null && isMaterial(composer, winner)) return winner;
  }
  return null;
}

/** @param {Composer} composer @param {string} path */
export const isMaterial = (composer, path) => composer.specsByPath[path]?.fields.typeName === "Material";

/** A primvar or null. Constant ones are inherited. @param {Composer} composer @param {string} prim @param {string}
 * name */
export function primvarOf(composer, prim, name) {
  for (const above of name ? upwards(prim) : []) {
    const found = arrayOf(composer, above, `primvars:${name}`, "constant");
    if (found && (above === prim || found.interpolation === "constant")) return found;
  }
  return null;
}

/** The same of an attribute. @param {Composer} composer @param {string} prim @param {string} name @param {string}
 * usual the interpolation where none is given */
export function arrayOf(composer, prim, name, usual) {
  const given = attributeOf(composer, prim, name);
  if (given === null || typeof given === "string") return null;
  const { typeName = "", interpolation = usual } = fieldsOf(composer, prim, name) ?? {};
  const [, size = 1] = Array.from(/(?<!\d)([234])[fdhi]?(?:\[\])?$/.exec(typeName) ?? [], Number);
  const all = ArrayBuffer.isView(given) ? /** @type {Float32Array} */ (given) : Float64Array.from([given].flat());
  const indices = attributeOf(composer, prim, `${name}:indices`);
  if (!indices?.length) return all.length >= size ? { values: all, size, interpolation } : null;
  const values = new Float64Array(size * indices.length);
  for (let i = 0; i < indices.length; i++)
    for (let part = 0; part < size; part++) values[size * i + part] = all[size * indices[i] + part] ?? 0;
  return { values, size, interpolation };
}

const SINGLE = /^(float|quatf)|\df(\[\])?$/;

/** Files of text have more digits than the values that they stand for. @type {(value: Value, type: string) => Value} */
function singles(value, type) {
  if (!SINGLE.test(type)) return value;
  if (typeof value === "number") return Math.fround(value);
  return Array.isArray(value) ? Float32Array.from(value) : value;
}
