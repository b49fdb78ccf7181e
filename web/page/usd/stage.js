// What a stage of USD says of its prims: values at its first moment, inherited bindings and primvars, which prims it shows.
// A prim is known by its path in a composer.

// A prim and those above it, the nearest first.
export function* upwards(path) {
  for (let at = path; at.length > 1; at = at.slice(0, Math.max(at.lastIndexOf("/"), 0))) yield at;
}

export const fieldsOf = (composer, prim, name) => composer.specsByPath[`${prim}.${name}`]?.fields ?? null;

export const valueOf = (composer, prim, name) => composer._resolveAttributeValue(`${prim}.${name}`) ?? null;

// What a relationship or a connection points to. Text has lists as one: "[/a/b, /a/c]".
export function targetsOf(paths, prim) {
  const names = [paths ?? []]
    .flat()
    .join()
    .replace(/[[\]<>\s]/g, "")
    .split(",")
    .filter((name) => name && name !== "None");
  return names.map((name) => (name.startsWith("/") ? name : `${prim}/${name}`));
}

// Methods for USDComposer. `kept`: its own ones. `found.moment`: the time, null for the earliest.
export const stageMethods = (kept, found) => ({
  _buildIndexes() {
    kept._buildIndexes.call(this);
    for (const [parent, children] of this.childrenByPath) {
      const order = this.specsByPath[parent]?.fields.primChildren;
      const places = new Map(order ? Array.from(order, (name, i) => [name, i]) : []);
      const sorted = places.size
        ? children.toSorted((a, b) => (places.get(a.name) ?? Infinity) - (places.get(b.name) ?? Infinity) || 0)
        : children;
      this.childrenByPath.set(
        parent,
        sorted.filter(({ path }) => isShown(this, path, found)),
      );
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

function sampleOf(times, values, moment, type) {
  const after = moment === null ? 0 : times.findIndex((time) => time >= moment);
  if (after < 0) return values.at(-1);
  if (after === 0 || times[after] === moment) return values[after];
  const [low, high] = [values[after - 1], values[after]];
  if (HELD.test(type) || low?.length !== high?.length || typeof low === "string") return low;
  const part = (moment - times[after - 1]) / (times[after] - times[after - 1]);
  const mixed = (a, b) => (1 - part) * a + part * b;
  return typeof low === "number" ? mixed(low, high) : Array.from(low, (one, i) => mixed(one, high[i]));
}

const OVER = 1;

// Whether a prim and those below it are shown, as far as the prim decides it. Prototypes, and what is below a prim that is
// not defined, need not be defined themselves.
export function isShown(composer, path, found, isPrototype = false) {
  const fields = composer.specsByPath[path]?.fields;
  if (!fields) return false;
  const { typeName, specifier, active } = fields;
  const above = composer.specsByPath[path.slice(0, path.lastIndexOf("/"))]?.fields ?? {};
  if (
    active === false ||
    (specifier >= OVER && !isPrototype && above.typeName !== "PointInstancer" && !(above.specifier >= OVER))
  )
    return false;
  if (!typeName) return true;
  if (valueOf(composer, path, "visibility") === "invisible") {
    found.warn("invisible", "invisible prims and their descendants were left out");
    return false;
  }
  const purpose = valueOf(composer, path, "purpose");
  if (purpose === null || purpose === "default" || purpose === "render") return true;
  found.warn("purpose", `prims of purpose ${purpose} and their descendants were left out`);
  return false;
}

const BINDINGS = ["material:binding:preview", "material:binding", "material:binding:full"];

// The path of the material of a prim: of the nearest binding above it, unless one further up is stronger.
export function boundMaterial(composer, prim) {
  for (const name of BINDINGS) {
    let winner = null;
    for (const above of upwards(prim)) {
      const fields = fieldsOf(composer, above, name);
      const [target] = targetsOf(fields?.targetPaths, above);
      if (target && (winner === null || fields.bindMaterialAs === "strongerThanDescendants")) winner = target;
    }
    if (winner !== null && isMaterial(composer, winner)) return winner;
  }
  return null;
}

export const isMaterial = (composer, path) => composer.specsByPath[path]?.fields.typeName === "Material";

// A primvar: {values, size: numbers per value, interpolation}; null for none. Prims inherit those that are constant.
export function primvarOf(composer, prim, name) {
  for (const above of name ? upwards(prim) : []) {
    const found = arrayOf(composer, above, `primvars:${name}`, "constant");
    if (found && (above === prim || found.interpolation === "constant")) return found;
  }
  return null;
}

// The same of an attribute.
export function arrayOf(composer, prim, name, usual) {
  const given = valueOf(composer, prim, name);
  if (given === null || typeof given === "string") return null;
  const { typeName = "", interpolation = usual } = fieldsOf(composer, prim, name);
  const [, size = 1] = Array.from(/(?<!\d)([234])[fdhi]?(?:\[\])?$/.exec(typeName) ?? [], Number);
  const all = ArrayBuffer.isView(given) ? given : Float64Array.from([given].flat());
  const indices = valueOf(composer, prim, `${name}:indices`);
  if (!indices?.length) return all.length >= size ? { values: all, size, interpolation } : null;
  const values = new Float64Array(size * indices.length);
  for (let i = 0; i < indices.length; i++)
    for (let part = 0; part < size; part++) values[size * i + part] = all[size * indices[i] + part] ?? 0;
  return { values, size, interpolation };
}

const SINGLE = /^(float|quatf)|\df(\[\])?$/;

// Files of text have more digits than the values that they stand for.
function singles(value, typeName) {
  if (!SINGLE.test(typeName)) return value;
  if (typeof value === "number") return Math.fround(value);
  return Array.isArray(value) ? Float32Array.from(value) : value;
}
