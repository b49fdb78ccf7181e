// What a stage of USD says of its prims: values at its first moment, inherited bindings and primvars, which prims it shows.
// A prim is known by its path in a composer, which is a layer with the variants that are chosen.

// A prim and those above it, the nearest first.
export function* upwards(path) {
  for (let at = path; at.length > 1; at = at.slice(0, Math.max(at.lastIndexOf("/"), 0))) yield at;
}

// The paths of a property: the prim's own, then those of chosen variants.
function* places(composer, prim, name) {
  yield `${prim}.${name}`;
  for (const above of upwards(prim)) for (const variant of composer._getVariantPaths(above)) yield `${variant}${prim.slice(above.length)}.${name}`;
}

export function fieldsOf(composer, prim, name) {
  for (const path of places(composer, prim, name)) if (composer.specsByPath[path]) return composer.specsByPath[path].fields;
  return null;
}

export function valueOf(composer, prim, name) {
  for (const path of places(composer, prim, name)) {
    const value = composer._resolveAttributeValue(path);
    if (value !== undefined && value !== null) return value;
  }
  return null;
}

// What a relationship or a connection points to. Text has lists as one: "[/a/b, /a/c]".
export function targetsOf(paths, prim) {
  const names = [paths ?? []].flat().join().replace(/[[\]<>\s]/g, "").split(",").filter((name) => name && name !== "None");
  return names.map((name) => (name.startsWith("/") ? name : `${prim}/${name}`));
}

// Methods for USDComposer. `kept`: its own ones. `found.moment`: the time, null for the earliest.
export const stageMethods = (kept, found) => ({
  _buildIndexes() {
    kept._buildIndexes.call(this);
    for (const [parent, children] of this.childrenByPath) {
      const order = this.specsByPath[parent]?.fields.primChildren;
      const places = new Map(order ? Array.from(order, (name, i) => [name, i]) : []);
      const sorted = places.size ? children.toSorted((a, b) => (places.get(a.name) ?? Infinity) - (places.get(b.name) ?? Infinity) || 0) : children;
      this.childrenByPath.set(parent, sorted.filter(({ path }) => isShown(this, path, found)));
    }
  },
  _resolveAttributeValue(path) {
    const fields = this.specsByPath[String(path).replace(/[<>]/g, "")]?.fields;
    const { times, values } = fields?.timeSamples ?? {};
    return times?.length ? sampleOf(times, values, found.moment, fields.typeName ?? "") : fields?.default;
  },
  // Those that are chosen; a set without a choice shows none.
  _getVariantPaths(path) {
    const { variantSetChildren, variantSelection } = this.specsByPath[path]?.fields ?? {};
    const chosen = Array.from(variantSetChildren ?? [], (set) => [set, this.externalVariantSelections[set] ?? variantSelection?.[set]]);
    return chosen.filter(([, name]) => name).map(([set, name]) => `${path}/{${set}=${name}}`);
  },
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

function isShown(composer, path, found) {
  const spec = composer.specsByPath[path];
  const { typeName, specifier, active } = spec.fields;
  const prototype = () => [...upwards(path)].some((above) => composer.specsByPath[above]?.fields.typeName === "PointInstancer");
  if (active === false || (specifier >= OVER && !prototype())) return false;
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
  const size = Number(/(?<!\d)([234])[fdhi]?(?:\[\])?$/.exec(typeName)?.[1] ?? 1);
  const all = singles([given].flat(), typeName);
  const indices = valueOf(composer, prim, `${name}:indices`);
  if (!indices?.length) return all.length >= size ? { values: all, size, interpolation } : null;
  const values = new Float64Array(size * indices.length);
  for (let i = 0; i < indices.length; i++) for (let part = 0; part < size; part++) values[size * i + part] = all[size * indices[i] + part] ?? 0;
  return { values, size, interpolation };
}

// Files of text have more digits than the values that they stand for.
export function singles(values, typeName) {
  const list = values.length === 1 && ArrayBuffer.isView(values[0]) ? values[0] : values;
  return ArrayBuffer.isView(list) ? list : typeName.includes("double") || /\dd/.test(typeName) ? Float64Array.from(list) : Float32Array.from(list);
}
