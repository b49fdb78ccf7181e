// References to prims of the same file, and prims that inherit from others: their specs are put in place of the reference.

import { targetsOf } from "./usd_stage.js";

const FIELDS = ["references", "payload", "inheritPaths", "specializes"];

// Methods for USDComposer. `kept`: its own ones.
export const referenceMethods = (kept, found) => ({
  _buildIndexes() {
    new References(this.specsByPath, found).follow();
    kept._buildIndexes.call(this);
  },
});

class References {
  constructor(specs, found) {
    Object.assign(this, { specs, found });
    this.below = new Map(); // path -> those of its properties and children
    this.settled = new Map(); // path -> whether its references are followed; false while they are
  }

  follow() {
    const refers = Object.keys(this.specs).filter((path) => path !== "/" && targetsWithin(this.specs[path].fields, path).length);
    if (!refers.length) return;
    for (const path in this.specs) this.note(path);
    for (const path of refers) this.settle(path);
  }

  note(path) {
    const at = Math.max(path.lastIndexOf("/"), path.lastIndexOf("."));
    const above = path.slice(0, at);
    if (!this.below.has(above)) this.below.set(above, []);
    this.below.get(above).push(path);
  }

  settle(path) {
    if (this.settled.get(path) === false) throw new Error(`${path}: refers to itself; repair its references`);
    if (this.settled.has(path)) return;
    this.settled.set(path, false);
    const { fields } = this.specs[path];
    for (const target of targetsWithin(fields, path)) {
      if (!this.specs[target]) continue;
      if (`${path}/`.startsWith(`${target}/`)) throw new Error(`${path}: refers to itself; repair its references`);
      this.settleAll(target);
      for (const name of FIELDS) if (fields[name]) fields[name] = [fields[name]].flat().map((one) => without(one, target)).filter(Boolean);
      this.copy(target, path, target, path);
    }
    for (const name of FIELDS) if (fields[name]?.length === 0) delete fields[name];
    this.settled.set(path, true);
  }

  settleAll(path) {
    if (this.specs[path]?.fields) this.settle(path);
    for (const part of this.below.get(path) ?? []) if (!part.slice(path.length).startsWith(".")) this.settleAll(part);
  }

  // What `to` does not say itself it takes from `from`, with all that is below it.
  copy(from, to, source, place) {
    this.found.charge(to, 0.25);
    const theirs = this.specs[from];
    const fields = { ...theirs.fields };
    for (const name of ["targetPaths", "connectionPaths"])
      if (fields[name]) fields[name] = targetsOf(fields[name], from).map((path) => (new RegExp(`^${source}(?=$|[/.])`).test(path) ? place + path.slice(source.length) : path));
    const own = this.specs[to];
    if (!own) this.note(to);
    if (own) {
      for (const name of FIELDS) delete fields[name];
      const children = new Set([...(fields.primChildren ?? []), ...(own.fields.primChildren ?? [])]);
      const specifier = own.fields.specifier === 1 ? fields.specifier : own.fields.specifier;
      Object.assign(own.fields, { ...fields, ...own.fields, ...(children.size && { primChildren: [...children] }) });
      if (specifier !== undefined) own.fields.specifier = specifier;
      own.fields.typeName ||= fields.typeName;
    } else this.specs[to] = { specType: theirs.specType, fields };
    for (const part of [...(this.below.get(from) ?? [])]) this.copy(part, to + part.slice(from.length), source, place);
  }
}

// The prims of the same file to which fields refer: "<path>" that follows no "@file@".
function targetsWithin(fields, path) {
  return FIELDS.flatMap((name) => [fields?.[name] ?? []].flat().flatMap((one) =>
    (typeof one !== "string" ? [] : one.startsWith("/") ? [one] : Array.from(one.replace(/@[^@]*@(<[^>]*>)?/g, "").matchAll(/<([^>]*)>/g), (match) => match[1]))))
    .flatMap((target) => targetsOf(target, path));
}

const without = (text, target) => (typeof text !== "string" || text === target ? "" : text.replace(`<${target}>`, "").replace(/^[\s,[\]]*$/, ""));
