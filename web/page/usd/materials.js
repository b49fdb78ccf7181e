// What each face of a prim of USD shows, as voxrt build reads it (voxelize/formats/usd/materials.py): the material bound to
// it or to its subset, else its displayColor, else the default material.

import { leftOut } from "../voxrt/opacity.js";
import { coordinates } from "./images.js";
import { noShading, readShading } from "./shading.js";
import { attributeOf, boundMaterial, fieldsOf, isMaterial, numbersOf, primvarOf, targetsOf } from "./stage.js";
import { placesOf } from "./surface.js";
/** @import { UsdImages } from "./images.js" @import { Described } from "../voxrt/scene.js" */
/** @import { Appearance, Voxrt } from "../voxrt/voxrt.js" @import { Warn } from "../voxrt/warnings.js" */
/** @import { Shading, Unnumbered } from "./shading.js" @import { Primvar } from "./stage.js" */
/** @import { FaceSurface } from "./surface.js" @import { Composer } from "./three_private.js" */

/** @typedef {(triangle: number, corner: number, out: { [at: number]: number }, to: number) => void} SetCorner */
/** @typedef {{ entry: Appearance, setUv?: SetCorner, setColour?: SetCorner }} CornerLook */
const DEFAULT_COLOUR = [200, 200, 200];
const MISSING = "textures that are missing or of an unsupported format were replaced by the fallback or default colour";
const UNPLACED = "textured faces without texture coordinates took the texture's fallback or the default colour";
const UNIFORM = "textured faces took one colour of their image: no texture coordinates are connected to it";
const UNCONNECTED = "textures without connected coordinates were placed by the coordinates 'st' of their meshes";

export class UsdMaterials {
  /** @type {Map<string, Shading>} by path */ #read = new Map();
  /** @type {Map<Shading, { textured?: Appearance, coloured?: Appearance }>} entries of surfaces */
  #entries = new Map();
  /** @type {Map<string, Shading>} equal shadings are one */ #known = new Map();
  /** @type {Map<string, number>} keys of uniform materials by their first use */ #order = new Map();

  /** @param {UsdImages} images @param {Voxrt} voxrt @param {Warn} warn */ constructor(images, voxrt, warn) {
    this.images = images;
    this.voxrt = voxrt;
    this.warn = warn;
  }

  /** The shadings of a prim, and the one of each face as an index, -1 for holes. @param {Composer} composer @param
   * {string} path @param {FaceSurface} surface */
  ofFaces(composer, path, surface) {
    /** @type {Shading[]} */ const shadings = [];
    const rows = new Int32Array(surface.faceCount).fill(-1);
    /** @param {Shading} shading */
    const row = (shading) => (shadings.includes(shading) ? shadings.indexOf(shading) : shadings.push(shading) - 1);
    for (const { path: subset } of composer.childrenByPath.get(path) ?? []) {
      const isSubset = composer.specsByPath[subset]?.fields.typeName === "GeomSubset";
      if (!isSubset || attributeOf(composer, subset, "familyName") !== "materialBind") continue;
      const indices = Array.from(numbersOf(composer, subset, "indices") ?? []);
      const count = surface.faceCount;
      if (!indices.every((face) => face >= 0 && face < count))
        throw new Error(`${subset}: a face subset refers to faces beyond the mesh's ${count}; export the mesh again`);
      const [material] = targetsOf(fieldsOf(composer, subset, "material:binding")?.targetPaths, subset);
      if (material && !isMaterial(composer, material))
        this.warn("missing-material", "bindings to materials that do not exist were ignored", indices.length);
      if (!isMaterial(composer, material)) continue;
      const at = row(this.shading(composer, material));
      for (const face of indices) rows[face] = at;
    }
    const left = surface.faces.filter((face) => rows[face] < 0);
    if (left.length) {
      const at = row(this.own(composer, path));
      for (const face of left) rows[face] = at;
    }
    return { shadings, rows };
  }

  /** @param {Composer} composer @param {string} material */ shading(composer, material) {
    const known = this.#read.get(material);
    if (known) return known;
    const made = readShading(composer, material, this.warn);
    for (const source of [made.image, made.alpha]) if (source) this.images.add(composer, source);
    const one = this.one(made);
    this.#read.set(material, one);
    return one;
  }

  /** @param {Unnumbered} shading */ one(shading) {
    const key = JSON.stringify(shading);
    const known = this.#known.get(key) ?? { ...shading, id: this.#known.size };
    this.#known.set(key, known);
    return known;
  }

  /** @param {Composer} composer @param {string} path */ own(composer, path) {
    const material = boundMaterial(composer, path);
    if (material) return this.shading(composer, material);
    const [opacity = 1] = equalOf(primvarOf(composer, path, "displayOpacity")) ?? [];
    const stored = primvarOf(composer, path, "displayColor");
    const colour = equalOf(stored);
    if (colour && colour.length >= 3) {
      const linear = colour.slice(0, 3);
      const code = this.srgb(linear)
        .map((part) => part.toString(16).padStart(2, "0"))
        .join("");
      return this.one({ ...noShading, name: `#${code}`, colour: linear, opacity });
    }
    return this.one({ ...noShading, opacity, ...(stored && { name: "displayColor", primvar: "displayColor" }) });
  }

  /** @param {readonly number[]} linear */ srgb = (linear) =>
    linear.map((part) => this.voxrt.srgb(Number.isNaN(part) || part < 0 ? 0 : Math.min(part, 1)));

  /** What faces of a shading show: null where they are left out. @param {Shading} shading @param {Composer} composer
   * @param {string} path @param {FaceSurface} surface @param {number} faces */
  show(shading, composer, path, surface, faces) {
    const reason = shading.alpha ? null : leftOut(shading.opacity, shading.cutoff);
    if (reason) {
      this.warn("transparent", reason, faces);
      return null;
    }
    const look =
      this.textured(shading, composer, path, surface, faces) ?? this.coloured(shading, composer, path, surface);
    return look ? { look } : { uniform: this.uniform(shading, faces) };
  }

  /** @param {Shading} shading @param {Composer} composer @param {string} path @param {FaceSurface} surface @param
   * {number} faces @returns {CornerLook | null} */
  textured(shading, composer, path, surface, faces) {
    const source = shading.image ?? shading.alpha;
    if (!source) return null;
    const texture = this.images.texture(shading);
    if (!texture) {
      this.warn("missing-texture", MISSING, faces);
      return null;
    }
    const stored = primvarOf(composer, path, source.primvar);
    const place = stored && stored.size >= 2 ? placesOf(source.primvar, stored, surface, this.warn) : null;
    if (!place && !source.point) {
      this.warn("texture", UNPLACED, faces);
      return null;
    }
    if (!place) this.warn("texture", UNIFORM, faces);
    else if (source.point) this.warn("texture", UNCONNECTED, faces);
    const plain = !shading.image && shading.colour ? shading.colour : [1, 1, 1];
    const moved = coordinates(source);
    /** @param {number} value */ const finite = (value) => (Number.isFinite(value) ? value : 0);
    return {
      entry: this.entry(shading, {
        name: shading.name ?? "texture",
        factor: [...plain, shading.alpha ? 1 : shading.opacity],
        texture,
        cutoff: shading.alpha ? shading.cutoff : 0,
      }),
      setUv: (triangle, corner, out, to) => {
        const at = place?.(triangle, corner);
        if (stored && at !== undefined) moved(finite(stored.values[at]), finite(stored.values[at + 1]), out, to);
        else if (source.point) moved(source.point[0], source.point[1], out, to);
      },
    };
  }

  /** @param {Shading} shading @param {Composer} composer @param {string} path @param {FaceSurface} surface @returns
   * {CornerLook | null} */
  coloured(shading, composer, path, surface) {
    const name = shading.primvar;
    const stored = name && primvarOf(composer, path, name);
    const place = stored && stored.size >= 3 ? placesOf(name, stored, surface, this.warn) : null;
    if (!stored || !place) return null;
    return {
      entry: this.entry(shading, { name: shading.name ?? name }),
      setColour: (triangle, corner, out, to) => {
        const at = place(triangle, corner);
        for (let part = 0; part < 3; part++) out[to + part] = Math.min(Math.max(stored.values[at + part] || 0, 0), 1);
      },
    };
  }

  /** The same object for the same look, and for no other one. @param {Shading} shading @param {Appearance} entry */
  entry(shading, entry) {
    const kind = entry.texture ? "textured" : "coloured";
    const known = this.#entries.get(shading) ?? {};
    this.#entries.set(shading, known);
    known[kind] ??= entry;
    return known[kind];
  }

  /** @param {Shading} shading @param {number} faces */ uniform({ name, colour }, faces) {
    if (name === null) this.warn("default-material", "faces without a material got the default one", faces);
    const srgb = name === null || !colour ? DEFAULT_COLOUR : this.srgb(colour);
    const key = name === null ? "" : `${name} ${srgb}`;
    const order = this.#order.get(key) ?? this.#order.size;
    this.#order.set(key, order);
    return { key, name: name ?? "default", colour: srgb, authored: name !== null, order };
  }
}

/** The one value of a primvar whose values are all equal; null for none. @param {Primvar | null} primvar */
function equalOf(primvar) {
  if (!primvar) return null;
  const { values, size } = primvar;
  for (let i = size; i + size <= values.length; i++) if (values[i] !== values[i % size]) return null;
  return Array.from(values.slice(0, size));
}
