// What each face of a prim of USD shows, as voxrt build reads it (voxelize/formats/usd/materials.py): the material bound to
// it or to its subset, else its displayColor, else the default material.

import { noShading, readShading } from "./shading.js";
import { coordinates } from "./images.js";
import { boundMaterial, fieldsOf, isMaterial, primvarOf, targetsOf, valueOf } from "./stage.js";
import { placesOf } from "./surface.js";

const DEFAULT_COLOUR = [200, 200, 200];

export class UsdMaterials {
  constructor(images, voxrt, warn) {
    Object.assign(this, { images, voxrt, warn });
    this.read = new Map(); // path -> shading
    this.entries = new Map(); // shading -> its entries of surfaces
    this.known = new Map(); // equal shadings are one
    this.order = new Map(); // keys of uniform materials by their first use
  }

  // The shadings of a prim, and the one of each face as an index, -1 for holes.
  ofFaces(composer, path, surface) {
    const shadings = [];
    const rows = new Int32Array(surface.faceCount).fill(-1);
    const row = (shading) => (shadings.includes(shading) ? shadings.indexOf(shading) : shadings.push(shading) - 1);
    for (const { path: subset } of composer.childrenByPath.get(path) ?? []) {
      if (
        composer.specsByPath[subset]?.fields.typeName !== "GeomSubset" ||
        valueOf(composer, subset, "familyName") !== "materialBind"
      )
        continue;
      const indices = valueOf(composer, subset, "indices") ?? [];
      if (!indices.every((face) => face >= 0 && face < surface.faceCount))
        throw new Error(
          `${subset}: a face subset refers to faces beyond the mesh's ${surface.faceCount}; export the mesh again`,
        );
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

  shading(composer, material) {
    if (!this.read.has(material)) {
      const made = readShading(composer, material, this.warn);
      for (const source of [made.image, made.alpha]) if (source) this.images.add(composer, source);
      this.read.set(material, this.one(made));
    }
    return this.read.get(material);
  }

  one(shading) {
    const key = JSON.stringify(shading);
    if (!this.known.has(key)) this.known.set(key, { ...shading, id: this.known.size });
    return this.known.get(key);
  }

  own(composer, path) {
    const material = boundMaterial(composer, path);
    if (material) return this.shading(composer, material);
    const [opacity = 1] = equalOf(primvarOf(composer, path, "displayOpacity")) ?? [];
    const given = primvarOf(composer, path, "displayColor");
    const colour = equalOf(given);
    if (colour?.length >= 3) {
      const linear = colour.slice(0, 3);
      const code = this.srgb(linear)
        .map((part) => part.toString(16).padStart(2, "0"))
        .join("");
      return this.one({ ...noShading, name: `#${code}`, colour: linear, opacity });
    }
    return this.one({ ...noShading, opacity, ...(given && { name: "displayColor", primvar: "displayColor" }) });
  }

  srgb(linear) {
    return linear.map((part) => this.voxrt.srgb(Number.isNaN(part) || part < 0 ? 0 : Math.min(part, 1)));
  }

  // What faces of a shading show: null where they are left out; {uniform} or {look}, which has an entry of a surface
  // (voxrt.js), and setUv(triangle, corner, out, at) or setColour of the same kind.
  show(shading, composer, path, surface, faces) {
    if (!shading.alpha && shading.opacity < shading.cutoff) {
      this.warn(
        "transparent",
        "faces of materials below their opacity threshold (0.5 by default) were left out",
        faces,
      );
      return null;
    }
    const look =
      this.textured(shading, composer, path, surface, faces) ?? this.coloured(shading, composer, path, surface);
    return look ? { look } : { uniform: this.uniform(shading, faces) };
  }

  textured(shading, composer, path, surface, faces) {
    const source = shading.image ?? shading.alpha;
    if (!source) return null;
    const texture = this.images.texture(shading);
    if (!texture) {
      this.warn(
        "missing-texture",
        "textures that are missing or of an unsupported format were replaced by the fallback or default colour",
        faces,
      );
      return null;
    }
    const stored = primvarOf(composer, path, source.primvar);
    const place = stored && stored.size >= 2 ? placesOf(source.primvar, stored, surface, this.warn) : null;
    if (!place && !source.point) {
      this.warn(
        "texture",
        "textured faces without texture coordinates took the texture's fallback or the default colour",
        faces,
      );
      return null;
    }
    if (!place)
      this.warn(
        "texture",
        "textured faces took one colour of their image: no texture coordinates are connected to it",
        faces,
      );
    else if (source.point)
      this.warn(
        "texture",
        "textures without connected coordinates were placed by the coordinates 'st' of their meshes",
        faces,
      );
    const plain = !shading.image && shading.colour ? shading.colour : [1, 1, 1];
    const moved = coordinates(source);
    const finite = (value) => (Number.isFinite(value) ? value : 0);
    return {
      entry: this.entry(shading, {
        name: shading.name ?? "texture",
        factor: [...plain, shading.alpha ? 1 : shading.opacity],
        texture,
        cutoff: shading.alpha ? shading.cutoff : 0,
      }),
      setUv: (triangle, corner, out, to) => {
        const at = place?.(triangle, corner);
        const [u, v] = place ? [finite(stored.values[at]), finite(stored.values[at + 1])] : source.point;
        moved(u, v, out, to);
      },
    };
  }

  coloured(shading, composer, path, surface) {
    const given = shading.primvar && primvarOf(composer, path, shading.primvar);
    const place = given && given.size >= 3 ? placesOf(shading.primvar, given, surface, this.warn) : null;
    if (!place) return null;
    return {
      entry: this.entry(shading, { name: shading.name ?? shading.primvar }),
      setColour: (triangle, corner, out, to) => {
        const at = place(triangle, corner);
        for (let part = 0; part < 3; part++) out[to + part] = Math.min(Math.max(given.values[at + part] || 0, 0), 1);
      },
    };
  }

  // The same object for the same look, and for no other one.
  entry(shading, entry) {
    const kind = entry.texture ? "textured" : "coloured";
    if (!this.entries.has(shading)) this.entries.set(shading, {});
    return (this.entries.get(shading)[kind] ??= entry);
  }

  uniform({ name, colour }, faces) {
    if (name === null) this.warn("default-material", "faces without a material got the default one", faces);
    const srgb = name === null || !colour ? DEFAULT_COLOUR : this.srgb(colour);
    const key = name === null ? "" : `${name} ${srgb}`;
    if (!this.order.has(key)) this.order.set(key, this.order.size);
    return { key, name: name ?? "default", colour: srgb, authored: name !== null, order: this.order.get(key) };
  }
}

// The one value of a primvar whose values are all equal.
function equalOf(primvar) {
  if (!primvar) return null;
  const { values, size } = primvar;
  for (let i = size; i + size <= values.length; i++) if (values[i] !== values[i % size]) return null;
  return Array.from(values.subarray(0, size));
}
