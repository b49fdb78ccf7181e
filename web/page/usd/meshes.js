// Meshes and solids of USD as meshes of three.js: the triangles and materials that voxrt build gives them, and their names.
//
// Each corner of each triangle is a vertex of its own. What triangles show is known when all images are decoded: until then
// meshes have an empty geometry.

import { BufferAttribute, BufferGeometry, Mesh, Object3D } from "../three/three.core.js";
import { posedPoints } from "./skin.js";
import { dimensionsOf, isNewSolid, isSolid } from "./solids.js";
import { arrayOf, attributeOf, primvarOf } from "./stage.js";
import { placesOf, surfaceOf } from "./surface.js";
/** @import { Material, Matrix4, Mesh as ThreeMesh } from "three" */
/** @import { Described, Look, Rules } from "../voxrt/scene.js" @import { Warn } from "../voxrt/warnings.js" */
/** @import { CornerLook, SetCorner, UsdMaterials } from "./materials.js" @import { Shading } from "./shading.js" */
/** @import { Posed } from "./skin.js" @import { Primvar } from "./stage.js" */
/** @import { FaceSurface } from "./surface.js" @import { Composer, MethodsOf } from "./three_private.js" */

/** @typedef {FaceSurface & { posed: Posed | null }} Surface */

/** A geometry that has no triangles yet, and what they come from; `rows`: the shading of each face, -1 for none.
 * @typedef {{ geometry: BufferGeometry, composer: Composer, path: string, surface: Surface, shadings: Shading[],
 * rows: Int32Array }} Made */

/** @typedef {(size: number, set: SetCorner, Kind?: Float64ArrayConstructor | Float32ArrayConstructor) =>
 * Float64Array | Float32Array} Gather values of all corners */

/** Meshes of three.js carry shadings in place of its materials. @param {Material} material */
const shadingOf = (material) => /** @type {Shading} */ (/** @type {unknown} */ (material));

export class UsdMeshes {
  /** @type {Map<string, Surface | null>} by path, or by the dimensions of solids */ #surfaces = new Map();
  /** @type {Map<Shading, Described>} */ #uniform = new Map();
  /** @type {Map<Surface, Map<string, Made>>} by surface and shadings */ #made = new Map();
  /** @type {Map<unknown, Map<Shading, Look>>} what is not of one colour, by geometry */ #looks = new Map();

  /** @param {UsdMaterials} materials @param {Warn} warn */ constructor(materials, warn) {
    this.materials = materials;
    this.warn = warn;
  }

  /** @type {MethodsOf<Composer>} */ methods = (kept) => {
    const build = this.#build.bind(this);
    const note = this.#note.bind(this);
    return {
      _buildMesh(path) {
        return build(this, path, "Mesh");
      },
      _buildGeomPrimitive(path, _spec, kind) {
        return build(this, path, kind);
      },
      _buildHierarchy(parent, path) {
        const kind = this.specsByPath[path]?.fields.typeName ?? "";
        if (isNewSolid(kind)) {
          const mesh = build(this, path, kind);
          mesh.name = "";
          mesh.matrix.identity();
          parent.add(mesh);
        } else note(kind);
        kept._buildHierarchy.call(this, parent, path);
      },
    };
  };

  /** @param {string} kind */ #note(kind) {
    if (/^(\w*Curves|Points|NurbsPatch|TetMesh|Volume)$/.test(kind))
      this.warn("unsupported-prim", `${kind} prims are not supported and were left out`);
    else if (/^(\w+Light(_1)?|Camera|Skeleton|LightFilter|LightPortal)$/.test(kind))
      this.warn("no-shape", `${kind} prims have no shape and were left out`);
  }

  /** @param {Composer} composer @param {string} path @param {string} kind */ #build(composer, path, kind) {
    const surface = this.#surfaceOf(composer, path, kind);
    const object = surface ? this.#meshOf(composer, path, surface) : new Object3D();
    object.name = path.slice(path.lastIndexOf("/") + 1);
    composer.applyTransform(object, composer.specsByPath[path].fields, composer._getAttributes(path));
    return surface?.posed?.frame ? inFrame(object, surface.posed.frame) : object;
  }

  /** @param {Composer} composer @param {string} path @param {Surface} surface */ #meshOf(composer, path, surface) {
    const { shadings, rows } = this.materials.ofFaces(composer, path, surface);
    const { geometry } = this.#madeOf(composer, path, surface, shadings, rows);
    return new Mesh(geometry, /** @type {Material[]} */ (/** @type {unknown} */ (shadings)));
  }

  /** @param {Composer} composer @param {string} path @param {string} kind */ #surfaceOf(composer, path, kind) {
    const dimensions = isSolid(kind) ? dimensionsOf(kind, path, (name) => attributeOf(composer, path, name)) : null;
    const key = dimensions ? `${kind} ${JSON.stringify(dimensions)}` : path;
    const known = this.#surfaces.get(key);
    if (known !== undefined) return known;
    const posed = kind === "Mesh" ? posedPoints(composer, path, this.warn) : null;
    const surface = surfaceOf(composer, path, kind, this.warn, posed?.positions);
    const made = surface && { ...surface, posed };
    this.#surfaces.set(key, made);
    return made;
  }

  /** Solids of one kind and look share their geometry. @param {Composer} composer @param {string} path @param
   * {Surface} surface @param {Shading[]} shadings @param {Int32Array} rows */
  #madeOf(composer, path, surface, shadings, rows) {
    const known = this.#made.get(surface) ?? new Map();
    this.#made.set(surface, known);
    const key = shadings.map(({ id }) => id).join();
    const made = known.get(key) ?? { geometry: new BufferGeometry(), composer, path, surface, shadings, rows };
    known.set(key, made);
    return made;
  }

  /** Give all geometries their triangles. */
  finish() {
    for (const known of this.#made.values()) for (const made of known.values()) this.#fill(made);
  }

  /** @param {Made} made */ #fill({ geometry, composer, path, surface, shadings, rows }) {
    const counts = new Array(shadings.length).fill(0);
    for (const row of rows) if (row >= 0) counts[row]++;
    const shown = shadings.map((shading, row) => this.materials.show(shading, composer, path, surface, counts[row]));
    const kept = Array.from(surface.faces.keys()).filter((triangle) => shown[rows[surface.faces[triangle]]]);
    /** @type {Gather} */ const gathered = (size, set, Kind = Float64Array) => {
      const values = new Kind(3 * size * kept.length);
      for (const [i, triangle] of kept.entries())
        for (let corner = 0; corner < 3; corner++) set(triangle, corner, values, size * (3 * i + corner));
      return values;
    };
    /** @type {SetCorner} */ const place = (triangle, corner, out, to) => {
      const at = 3 * surface.triangles[3 * triangle + corner];
      for (let part = 0; part < 3; part++) out[to + part] = surface.positions[at + part];
    };
    geometry.setAttribute("position", new BufferAttribute(gathered(3, place), 3));
    const normals = surface.cornerCount && !surface.posed ? this.#normalsOf(composer, path, surface) : null;
    if (normals) geometry.setAttribute("normal", new BufferAttribute(gathered(3, normals, Float32Array), 3));
    for (const [i, triangle] of kept.entries()) {
      const row = rows[surface.faces[triangle]];
      const last = geometry.groups.at(-1);
      if (last?.materialIndex === row) last.count += 3;
      else geometry.addGroup(3 * i, 3, row);
    }
    /** @type {Map<Shading, Look>} */ const looks = new Map();
    this.#looks.set(geometry, looks);
    for (const [row, shading] of shadings.entries()) {
      const { uniform, look } = shown[row] ?? {};
      if (look) looks.set(shading, lookOf(look, gathered));
      if (uniform) this.#uniform.set(shading, uniform);
    }
  }

  /** @param {Composer} composer @param {string} path @param {Surface} surface */ #normalsOf(composer, path, surface) {
    /** @param {Primvar | null} normals @returns {SetCorner | null} */ const setterOf = (normals) => {
      const place = normals?.size === 3 ? placesOf("normals", normals, surface, this.warn) : null;
      if (!normals || !place) return null;
      return (triangle, corner, out, to) => {
        const at = place(triangle, corner);
        for (let part = 0; part < 3; part++)
          out[to + part] = Number.isFinite(normals.values[at + part]) ? normals.values[at + part] : 0;
      };
    };
    return setterOf(primvarOf(composer, path, "normals")) ?? setterOf(arrayOf(composer, path, "normals", "vertex"));
  }

  /** @type {Partial<Rules>} */ rules = {
    nameOf: pathOf,
    appearanceOf: (material, geometry) => this.#looks.get(geometry)?.get(shadingOf(material)) ?? null,
    materialOf: (material) => this.#uniform.get(shadingOf(material)),
  };
}

/** A mesh whose points have another frame than those below it. @param {Object3D} mesh @param {Matrix4} frame */
function inFrame(mesh, frame) {
  const prim = new Object3D();
  prim.matrixAutoUpdate = false;
  prim.matrix.copy(mesh.matrix);
  prim.name = mesh.name;
  mesh.name = "";
  mesh.matrix.copy(mesh.matrix).invert().multiply(frame);
  prim.add(mesh);
  return prim;
}

/** @param {CornerLook} look @param {Gather} gathered @returns {Look} */
function lookOf({ entry, setUv, setColour }, gathered) {
  const uv = setUv && gathered(2, setUv);
  const colour = setColour && gathered(3, setColour, Float32Array);
  return {
    entry,
    ...(uv && {
      uvOf: (vertex, out) => {
        out[0] = uv[2 * vertex];
        out[1] = uv[2 * vertex + 1];
      },
    }),
    ...(colour && {
      colourOf: (vertex, out) => {
        for (let channel = 0; channel < 3; channel++) out[channel] = colour[3 * vertex + channel];
        out[3] = 1;
      },
    }),
  };
}

/** The path of a prim, as voxrt build names objects: copies of instancers have the instancer's path and their
 * number. @param {ThreeMesh} mesh */
function pathOf(mesh) {
  const parts = [];
  for (let at = /** @type {any} */ (mesh); at?.parent; at = at.userData.copies ? at.parent.parent : at.parent)
    if (at.name && !at.parent.userData.copies) parts.push(at.name);
  return `/${parts.reverse().join("/")}`;
}
