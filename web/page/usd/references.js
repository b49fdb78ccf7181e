// References of USD prims to prims of the same file, of other files of a package and of files dropped together, prims that
// inherit from others, and sublayers: their specs are put in place of the reference, below what the prim itself says.

import { targetsOf } from "./stage.js";
/** @import { Fields, Found, List, Specs } from "./stage.js" */
/** @import { Composer, MethodsOf } from "./three_private.js" */

const ARCS = /** @type {const} */ (["references", "payload", "inheritPaths", "specializes"]);
export const ELSEWHERE = [...ARCS, "subLayers"];
/** @typedef {(file: string) => Specs | null} LayerOf the specs of a file; null for none */

/** @param {Found} found @returns {MethodsOf<Composer>} */ export const referenceMethods = (found) => (kept) => ({
  _buildIndexes() {
    /** @type {LayerOf} */ const layerOf = (file) => {
      const asset = this.assets[file];
      return (asset && "specsByPath" in asset ? asset.specsByPath : null) ?? found.layer(file);
    };
    const layer = new Layer(this.specsByPath, this.basePath, layerOf, new Map(), found.charge);
    layer.isRoot = true;
    layer.follow();
    if (layer.below.size) layer.choose("");
    kept._buildIndexes.call(this);
  },
});

class Layer {
  /** @type {Map<string, string[]>} the paths of properties and children by path, once they are needed */
  below = new Map();
  /** @type {Map<string, boolean>} whether the references of a path are followed; false while they are */
  #settled = new Map();
  isRoot = false; // the layer that chooses variants: it may choose others than those that it refers to

  /** @param {Specs} specs @param {string} folder @param {LayerOf} layerOf @param {Map<string, Layer | null>} layers
   * those that were read, by file @param {Found["charge"]} charge */
  constructor(specs, folder, layerOf, layers, charge) {
    this.specs = specs;
    this.folder = folder;
    this.layerOf = layerOf;
    this.layers = layers;
    this.charge = charge;
  }

  #list() {
    if (!this.below.size) for (const path in this.specs) this.note(path);
  }

  follow() {
    const { fields } = this.specs["/"] ?? { fields: {} };
    const refers = Object.keys(this.specs).filter(
      (path) => path !== "/" && arcsOf(this.specs[path].fields, path).length,
    );
    const varies = this.isRoot && Object.values(this.specs).some((spec) => spec.fields?.variantSetChildren);
    if (!refers.length && !fields.subLayers && !varies) return this;
    this.#list();
    for (const path of refers) this.settle(path);
    for (const file of filesOf(fields.subLayers)) {
      const layer = this.layer(file);
      if (!layer) continue;
      fields.subLayers = [fields.subLayers]
        .flat()
        .map((one) => String(one).replaceAll(file, ""))
        .filter((one) => /[^@\s,[\]]/.test(one));
      for (const path of layer.below.get("") ?? [])
        if (path.startsWith("/") && path !== "/") this.copy(layer, path, path, path, path, true);
      fields.primChildren = [
        ...new Set([...(layer.specs["/"].fields.primChildren ?? []), ...(fields.primChildren ?? [])]),
      ];
    }
    if (fields.subLayers?.length === 0) delete fields.subLayers;
    return this;
  }

  /** Another file, with its references followed; null for none. @param {string} file */
  layer(file) {
    const path = this.resolved(file);
    const known = this.layers.get(path);
    if (known !== undefined) return known;
    this.layers.set(path, null);
    const specs = this.layerOf(path);
    if (!specs) return null;
    const folder = path.slice(0, Math.max(path.lastIndexOf("/"), 0));
    const made = new Layer(specs, folder, this.layerOf, this.layers, this.charge).follow();
    made.#list();
    this.layers.set(path, made);
    return made;
  }

  /** @param {string} file */ resolved(file) {
    /** @type {string[]} */ const parts = [];
    for (const part of `${this.folder}/${file}`.split("/")) {
      if (part === "..") parts.pop();
      else if (part && part !== ".") parts.push(part);
    }
    return parts.join("/");
  }

  /** @param {string} path */ note(path) {
    const above = path.slice(0, Math.max(path.lastIndexOf("/"), path.lastIndexOf("."), 0));
    this.below.set(above, this.below.get(above) ?? []);
    this.below.get(above)?.push(path);
  }

  /** @param {string} path */ settle(path) {
    if (this.#settled.get(path) === false) throw new Error(`${path}: refers to itself; repair its references`);
    if (this.#settled.has(path)) return;
    this.#settled.set(path, false);
    const { fields } = this.specs[path];
    const arcs = arcsOf(fields, path);
    if (this.isRoot && arcs.length) this.takeVariants(path); // they are stronger
    for (const { file, prim, text } of arcs) {
      const layer = file ? this.layer(file) : this;
      const target = prim || `/${layer?.specs["/"]?.fields.defaultPrim ?? ""}`;
      if (!layer?.specs[target] || target === "/") continue;
      if (layer === this && `${path}/`.startsWith(`${target}/`))
        throw new Error(`${path}: refers to itself; repair its references`);
      if (layer === this) this.settleAll(target);
      for (const name of ARCS)
        if (fields[name])
          fields[name] = [fields[name]]
            .flat()
            .map((one) => without(one, text))
            .filter(Boolean);
      this.copy(layer, target, path, target, path, layer === this);
    }
    for (const name of ARCS) if (fields[name]?.length === 0) delete fields[name];
    this.#settled.set(path, true);
  }

  /** Choose the variants of all prims below a path. @param {string} path */
  choose(path) {
    if (this.specs[path]) this.takeVariants(path);
    for (const part of this.below.get(path) ?? []) if (/^\/?[^/.{]+$/.test(part.slice(path.length))) this.choose(part);
  }

  /** The chosen variants say what a prim does not say itself. They may bring more. @param {string} path */
  takeVariants(path) {
    const { fields } = this.specs[path];
    const taken = new Set();
    const next = () => fields.variantSetChildren?.find((one) => !taken.has(one));
    for (let set = next(); set !== undefined; set = next()) {
      taken.add(set);
      const variant = `${path}/{${set}=${fields.variantSelection?.[set]}}`;
      if (!this.specs[variant]) continue;
      this.settleAll(variant);
      this.copy(this, variant, path, variant, path, true);
    }
    delete fields.variantSetChildren;
  }

  /** @param {string} path */ settleAll(path) {
    if (this.specs[path]?.fields) this.settle(path);
    for (const part of this.below.get(path) ?? []) if (!part.slice(path.length).startsWith(".")) this.settleAll(part);
  }

  /** What `to` does not say itself it takes from `from` of a layer, with all that is below it: `place` stands for
   * `source`. What points elsewhere stays if `keeps`; else it points to what is not there. @param {Layer} layer
   * @param {string} from @param {string} to @param {string} source @param {string} place @param {boolean} keeps */
  copy(layer, from, to, source, place, keeps) {
    this.charge(to, 0.25);
    const theirs = layer.specs[from];
    const fields = { ...theirs.fields };
    /** @param {string} path */
    const isInside = (path) => path === source || path.startsWith(`${source}/`) || path.startsWith(`${source}.`);
    for (const name of /** @type {const} */ (["targetPaths", "connectionPaths"])) {
      if (!fields[name]) continue;
      const targets = targetsOf(fields[name], from).filter((path) => keeps || isInside(path));
      fields[name] = targets.map((path) => (isInside(path) ? place + path.slice(source.length) : path));
    }
    if (layer !== this && fields.typeName === "asset" && typeof fields.default === "string")
      fields.default = layer.resolved(fields.default.replace(/^@+|@+$/g, ""));
    const own = this.specs[to];
    if (own) {
      for (const name of ARCS) delete fields[name];
      const specifier = own.fields.specifier === 1 ? fields.specifier : own.fields.specifier;
      for (const name of /** @type {const} */ (["primChildren", "variantSetChildren", "apiSchemas"])) {
        const [theirs, ours] = [fields[name], own.fields[name]];
        if (theirs && ours) own.fields[name] = [...new Set([...theirs, ...ours])];
      }
      if (fields.variantSelection)
        own.fields.variantSelection = { ...fields.variantSelection, ...own.fields.variantSelection };
      Object.assign(own.fields, { ...fields, ...own.fields });
      if (specifier !== undefined) own.fields.specifier = specifier;
      own.fields.typeName ||= fields.typeName;
    } else {
      this.note(to);
      this.specs[to] = { specType: theirs.specType, fields };
    }
    for (const part of [...(layer.below.get(from) ?? [])])
      this.copy(layer, part, to + part.slice(from.length), source, place, keeps);
  }
}

/** What a prim refers to. @param {Fields | undefined} fields @param {string} path */
function arcsOf(fields, path) {
  return ARCS.flatMap((name) =>
    [fields?.[name] ?? []].flat().flatMap((one) => {
      if (typeof one !== "string") return [];
      if (one.startsWith("/")) return [{ file: "", prim: one, text: one }];
      return Array.from(one.matchAll(/@([^@]*)@(?:<([^>]*)>)?|<([^>]*)>/g), ([text, file = "", there, here]) => ({
        file,
        prim: there ?? (here ? (targetsOf(here, path)[0] ?? "") : ""),
        text,
      }));
    }),
  );
}

/** @param {List | undefined} list */ const filesOf = (list) =>
  [list ?? []]
    .flat()
    .flatMap((one) =>
      String(one).includes("@") ? Array.from(String(one).matchAll(/@([^@]+)@/g), (match) => match[1]) : [String(one)],
    );

/** A field without one of its references; empty where none is left. @param {string} one @param {string} text */
const without = (one, text) =>
  typeof one !== "string" || one === text ? "" : one.replace(text, "").replace(/^[\s,[\]]*$/, "");
