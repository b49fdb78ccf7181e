// Meshes and solids of USD as meshes of three.js: the triangles and materials that voxrt build gives them, and their names.
//
// Each corner of each triangle is a vertex of its own. What triangles show is known when all images are decoded: until then
// meshes have an empty geometry.

import { dimensionsOf, isNewSolid, isSolid } from "./solids.js";
import { posedPoints } from "./skin.js";
import { arrayOf, primvarOf, valueOf } from "./stage.js";
import { placesOf, surfaceOf } from "./surface.js";
import { BufferAttribute, BufferGeometry, Mesh, Object3D } from "../three/three.core.js";

export class UsdMeshes {
  constructor(materials, warn) {
    Object.assign(this, { materials, warn });
    this.surfaces = new Map(); // by path, or by the dimensions of solids
    this.uniform = new Map(); // shading -> material
    this.made = new Map(); // surface -> rows of faces -> what finish() needs
  }

  // Methods for USDComposer. `kept`: its own ones.
  methods = (kept) => {
    const meshes = this;
    return {
      _buildMesh(path) {
        return meshes.build(this, path, "Mesh");
      },
      _buildGeomPrimitive(path, _spec, kind) {
        return meshes.build(this, path, kind);
      },
      _buildHierarchy(parent, path) {
        const kind = this.specsByPath[path]?.fields.typeName ?? "";
        if (isNewSolid(kind)) {
          const mesh = meshes.build(this, path, kind);
          mesh.name = "";
          mesh.matrix.identity();
          parent.add(mesh);
        } else meshes.note(kind);
        kept._buildHierarchy.call(this, parent, path);
      },
    };
  };

  note(kind) {
    if (/^(\w*Curves|Points|NurbsPatch|TetMesh|Volume)$/.test(kind))
      this.warn("unsupported-prim", `${kind} prims are not supported and were left out`);
    else if (/^(\w+Light(_1)?|Camera|Skeleton|LightFilter|LightPortal)$/.test(kind))
      this.warn("no-shape", `${kind} prims have no shape and were left out`);
  }

  build(composer, path, kind) {
    const surface = this.surfaceOf(composer, path, kind);
    let object = new Object3D();
    if (surface) {
      const { shadings, rows } = this.materials.ofFaces(composer, path, surface);
      const made = this.madeOf(composer, path, surface, shadings, rows);
      object = new Mesh(made.geometry, shadings);
    }
    object.name = path.slice(path.lastIndexOf("/") + 1);
    composer.applyTransform(object, composer.specsByPath[path].fields, composer._getAttributes(path));
    return surface?.posed?.frame ? inFrame(object, surface.posed.frame) : object;
  }

  surfaceOf(composer, path, kind) {
    const key = isSolid(kind) ? `${kind} ${dimensionsOf(kind, path, (name) => valueOf(composer, path, name))}` : path;
    if (!this.surfaces.has(key)) {
      const posed = kind === "Mesh" ? posedPoints(composer, path, this.warn) : null;
      const surface = surfaceOf(composer, path, kind, this.warn, posed?.positions);
      this.surfaces.set(key, surface && { ...surface, posed });
    }
    return this.surfaces.get(key);
  }

  // Solids of one kind and look share their geometry.
  madeOf(composer, path, surface, shadings, rows) {
    if (!this.made.has(surface)) this.made.set(surface, new Map());
    const known = this.made.get(surface);
    const key = shadings.map(({ id }) => id).join();
    if (!known.has(key)) known.set(key, { geometry: new BufferGeometry(), composer, path, surface, shadings, rows });
    return known.get(key);
  }

  // Give all geometries their triangles.
  finish() {
    for (const known of this.made.values()) for (const made of known.values()) this.fill(made);
  }

  fill({ geometry, composer, path, surface, shadings, rows }) {
    const counts = new Array(shadings.length).fill(0);
    for (const row of rows) if (row >= 0) counts[row]++;
    const shown = shadings.map((shading, row) => this.materials.show(shading, composer, path, surface, counts[row]));
    const kept = [];
    for (let triangle = 0; triangle < surface.faces.length; triangle++)
      if (shown[rows[surface.faces[triangle]]]) kept.push(triangle);
    const gathered = (size, read, Kind = Float64Array) => {
      const values = new Kind(3 * size * kept.length);
      kept.forEach((triangle, i) => {
        for (let corner = 0; corner < 3; corner++) read(triangle, corner, values, size * (3 * i + corner));
      });
      return values;
    };
    const place = (triangle, corner, out, to) => {
      const at = 3 * surface.triangles[3 * triangle + corner];
      for (let part = 0; part < 3; part++) out[to + part] = surface.positions[at + part];
    };
    geometry.setAttribute("position", new BufferAttribute(gathered(3, place), 3));
    const normals = surface.cornerCount && !surface.posed ? this.normalsOf(composer, path, surface) : null;
    if (normals) geometry.setAttribute("normal", new BufferAttribute(gathered(3, normals, Float32Array), 3));
    kept.forEach((triangle, i) => {
      const row = rows[surface.faces[triangle]];
      const last = geometry.groups.at(-1);
      if (last?.materialIndex === row) last.count += 3;
      else geometry.addGroup(3 * i, 3, row);
    });
    geometry.userData.looks = new Map();
    for (const [row, shading] of shadings.entries()) {
      const { uniform, look } = shown[row] ?? {};
      if (look) geometry.userData.looks.set(shading, { entry: look.entry, ...settersOf(look, gathered) });
      if (uniform) this.uniform.set(shading, uniform);
    }
  }

  normalsOf(composer, path, surface) {
    const given = primvarOf(composer, path, "normals");
    const places = (normals) => (normals?.size === 3 ? placesOf("normals", normals, surface, this.warn) : null);
    let [normals, place] = [given, places(given)];
    if (!place) {
      normals = arrayOf(composer, path, "normals", "vertex");
      place = places(normals);
    }
    return (
      place &&
      ((triangle, corner, out, to) => {
        const at = place(triangle, corner);
        for (let part = 0; part < 3; part++)
          out[to + part] = Number.isFinite(normals.values[at + part]) ? normals.values[at + part] : 0;
      })
    );
  }

  // Rules for sceneOf.
  rules = {
    nameOf: pathOf,
    appearanceOf: (shading, geometry) => geometry.userData.looks.get(shading) ?? null,
    materialOf: (shading) => this.uniform.get(shading),
  };
}

// A mesh whose points are in another frame than those below it: the frame of the prim itself holds both.
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

function settersOf({ setUv, setColour }, gathered) {
  const uv = setUv && gathered(2, setUv);
  const colour = setColour && gathered(3, setColour, Float32Array);
  return {
    uvOf:
      uv &&
      ((vertex, out) => {
        out[0] = uv[2 * vertex];
        out[1] = uv[2 * vertex + 1];
      }),
    colourOf:
      colour &&
      ((vertex, out) => {
        out.set(colour.subarray(3 * vertex, 3 * vertex + 3));
        out[3] = 1;
      }),
  };
}

// The path of a prim, as voxrt build names objects: copies of instancers have the instancer's path and their number.
function pathOf(mesh) {
  const parts = [];
  for (let object = mesh; object?.parent; object = object.userData.copies ? object.parent.parent : object.parent)
    if (object.name && !object.parent.userData.copies) parts.push(object.name);
  return `/${parts.reverse().join("/")}`;
}
