// Objects of three.js as a scene for Voxrt.voxelize. Nothing of three.js is imported: only what its objects hold is read.
//
//     const scene = sceneOf(mesh, voxrt);
//     const { words } = voxrt.voxelize(scene, { depth: 7 });
//
// Each visible mesh becomes an object, in the order of the scene graph; positions are those of the moment, with morph
// targets and skins applied. Textures that are in memory and vertex colours give triangles an appearance; a plain
// material counts by its colour. `warnings` name what else materials have.

import { appearanceOfThree, colourOf } from "./three_looks.js";
import { isDeformed, joined, PAINTED } from "./triangles.js";
import { Warnings } from "./warnings.js";

export { colours } from "./three_looks.js";

/** @typedef {import("./three_looks.js").Attribute} Attribute */
/** @typedef {import("./three_looks.js").Look} Look */
/** @typedef {import("./three_looks.js").Setter} Setter */

/** @import { BufferGeometry, InstancedMesh, Material as ThreeMaterial, Mesh as ThreeMesh, Object3D } from "three" */
/** @import { Joined } from "./triangles.js" */
/** @import { Fill, Mesh, Rule, Scene, SceneObject, Triple, Warning } from "./scene_format.js" */
/** @import { Voxrt } from "./voxrt.js" @import { Warn } from "./warnings.js" */

/** A material of the scene; those of equal keys are one, and `order` sorts them. `colour` (sRGB) replaces that of
 * the material of three.js. @typedef {{ key: unknown, name: string, order?: number, colour?: Triple, mirror?:
 * boolean, authored?: boolean }} Described */

/** How a file differs from a scene graph. `groupOf`: what makes meshes one object; `materialOf`: null for the
 * default material; `appearanceOf`: null where the colour of the material is uniform; `leavesOut`: why faces
 * of a material are left out, or null; `normalsOf`: the author's normals, for baked light. @typedef {{ groupOf: (mesh:
 * ThreeMesh) => Object3D, nameOf: (mesh: ThreeMesh, group: Object3D) => string, choicesOf: (group: Object3D) => { rule?: Rule | null, fill?: Fill | null }, materialOf: (material:
 * ThreeMaterial) => Described | null | undefined, appearanceOf: (material: ThreeMaterial, geometry: BufferGeometry,
 * warn: Warn) => Look | null, leavesOut: (material: ThreeMaterial) => string | null, normalsOf: (mesh: ThreeMesh) =>
 * Attribute | null }} Rules */

/** @type {Rules} */ const PLAIN = {
  normalsOf: (mesh) => (isDeformed(mesh) ? null : (mesh.geometry.getAttribute("normal") ?? null)),
  appearanceOf: appearanceOfThree,
  leavesOut: () => null,
  groupOf: (mesh) => mesh,
  nameOf: (mesh) => mesh.name || "mesh",
  choicesOf: () => ({}),
  materialOf: (material) => (material ? { key: material, name: material.name || "material" } : null),
};

const DEFAULT = { name: "default", colour: [200, 200, 200], authored: false };

/** The visible meshes below an object of three.js, at this moment. @param {Object3D} root @param {Voxrt} voxrt
 * @param {Partial<Rules>} [rules] @returns {Scene & { warnings: Warning[] }} */
export function sceneOf(root, voxrt, rules = {}) {
  const all = { ...PLAIN, ...rules };
  const warnings = new Warnings();
  root.updateMatrixWorld?.(true);
  const table = new Materials(all, voxrt);
  /** @type {Joined[]} */ const meshes = [];
  /** @type {SceneObject[]} */ const objects = [];
  /** @type {Map<string, number>} the mesh, by what parts that do not deform show; -1 for no triangles */
  const known = new Map();
  for (const [group, parts] of groupsBelow(root, all, warnings.warn)) {
    const look = parts.some(isDeformed) ? null : lookOf(parts);
    let mesh = look === null ? undefined : known.get(look);
    if (mesh === undefined) {
      const made = joined(parts, all, (material) => table.keyOf(material), warnings.warn);
      mesh = made.triangles.length ? meshes.push(made) - 1 : -1;
      if (look !== null) known.set(look, mesh);
    }
    if (mesh < 0) continue;
    parts[0].updateMatrixWorld?.();
    const placed = placesOf(parts[0]);
    for (const [i, matrix] of placed.entries()) {
      const name = all.nameOf(parts[0], group) + (placed.length > 1 ? ` [${i}]` : "");
      objects.push({ name, mesh, transform: rows(matrix), ...all.choicesOf(group) });
    }
  }
  const numbered = meshes.map(({ keys, ...mesh }) => ({ ...mesh, materials: table.idsOf(keys) }));
  const bare = table.defaultId();
  const count = numbered.reduce((sum, { materials }) => sum + materials.filter((id) => id === bare).length, 0);
  if (bare !== undefined) warnings.warn("default-material", "faces without a material got the default one", count);
  return { materials: table.list(), meshes: numbered, objects, warnings: warnings.list() };
}

/** The materials in use, by their keys. */
class Materials {
  /** @type {Map<unknown, Described & { order: number, colour: Triple }>} */ #known = new Map();

  /** @param {Rules} rules @param {Voxrt} voxrt */ constructor(rules, voxrt) {
    this.rules = rules;
    this.voxrt = voxrt;
  }

  /** @param {ThreeMaterial} material */ keyOf(material) {
    const found = this.rules.materialOf(material) ?? { ...DEFAULT, key: DEFAULT, order: Infinity };
    const { key, order = this.#known.size } = found;
    if (!this.#known.has(key))
      this.#known.set(key, { ...found, order, colour: found.colour ?? colourOf(material, this.voxrt) });
    return key;
  }

  #ordered() {
    return [...this.#known].sort(([, a], [, b]) => a.order - b.order);
  }

  #ids() {
    return new Map(this.#ordered().map(([key], i) => [key, i + 1]));
  }

  /** The id of each triangle's key, 0 for those with an appearance. @param {unknown[]} keys */
  idsOf(keys) {
    const ids = this.#ids();
    return Uint8Array.from(keys, (key) => (key === PAINTED ? 0 : (ids.get(key) ?? 0)));
  }

  defaultId() {
    return this.#ids().get(DEFAULT);
  }

  list() {
    return this.#ordered().map(([, one]) => {
      const { name, colour, mirror = false, authored = true } = one;
      return { name, colour, mirror, authored };
    });
  }
}

/** The visible meshes, by what makes them one object. @param {Object3D} root @param {Rules} rules @param {Warn} warn */
function groupsBelow(root, { groupOf }, warn) {
  /** @type {Map<Object3D, ThreeMesh[]>} */ const groups = new Map();
  visit(root, (object) => {
    const kind = "isPoints" in object ? "points" : "isLine" in object ? "lines" : null;
    if (kind) warn("no-area", `${kind} were left out: they have no area to voxelize`);
    if (!("isMesh" in object)) return;
    const mesh = /** @type {ThreeMesh} */ (object);
    if (!mesh.geometry?.getAttribute("position")) return;
    const key = groupOf(mesh);
    groups.set(key, [...(groups.get(key) ?? []), mesh]);
  });
  return groups;
}

/** @param {Object3D} object @param {(object: Object3D) => void} see */ function visit(object, see) {
  if (!object.visible) return;
  see(object);
  for (const child of object.children) visit(child, see);
}

/** @param {ThreeMesh[]} parts */ const lookOf = (parts) =>
  parts.map(({ geometry, material }) => [geometry.id, [material].flat().map((one) => one?.id)].join()).join(";");

/** The matrices of an object, several where it has instances. @param {ThreeMesh} mesh @returns {ArrayLike<number>[]} */
function placesOf(mesh) {
  const world = mesh.matrixWorld.elements;
  if (!("isInstancedMesh" in mesh)) return [world];
  const { count, instanceMatrix } = /** @type {InstancedMesh} */ (mesh);
  return Array.from({ length: count }, (_, i) => product(world, instanceMatrix.array.subarray(16 * i, 16 * i + 16)));
}

/** A matrix of three.js (columns) as 3 rows of 4. @param {ArrayLike<number>} m */
const rows = (m) => [m[0], m[4], m[8], m[12], m[1], m[5], m[9], m[13], m[2], m[6], m[10], m[14]];

/** @param {ArrayLike<number>} a @param {ArrayLike<number>} b */ const product = (a, b) =>
  Array.from({ length: 16 }, (_, at) => {
    const [column, row] = [at >> 2, at & 3];
    return [0, 1, 2, 3].reduce((sum, i) => sum + a[row + 4 * i] * b[4 * column + i], 0);
  });
