// Meshes of three.js as triangles: positions, the material of each triangle, textures, colours and normals.

/** @import { BufferGeometry, Material, Mesh as ThreeMesh, SkinnedMesh } from "three" */
/** @import { Rules } from "./scene.js" @import { Attribute, Look } from "./three_looks.js" */
/** @import { Mesh, Surface } from "./scene_format.js" @import { Warn } from "./warnings.js" */

/** @typedef {Omit<Mesh, "materials"> & { keys: unknown[] }} Joined `keys`: of the material of each triangle */

/** A triangle with an appearance, and where its corners stand among those of its mesh. @typedef {{ triangle: number,
 * look: Look, corners: ArrayLike<number>, at: number }} Painted */

export const PAINTED = Symbol("painted"); // in place of the material of a triangle with an appearance

/** Several meshes of one place as one. @param {ThreeMesh[]} parts @param {Rules} rules @param {(material: Material)
 * => unknown} keyOf @param {Warn} warn @returns {Joined} */
export function joined(parts, rules, keyOf, warn) {
  const positions = [];
  /** @type {number[]} */ const triangles = [];
  /** @type {unknown[]} */ const keys = [];
  /** @type {Painted[]} */ const painted = [];
  /** @type {[number, Attribute][]} the first vertex and the normals of a mesh */ const normals = [];
  let first = 0;
  for (const mesh of parts) {
    const { geometry } = mesh;
    const place = positionsOf(mesh);
    const count = place.length / 3;
    const corners = cornersOf(geometry, count);
    for (const [start, end, material] of runsOf(mesh, corners.length, warn)) {
      if (end <= start) continue;
      const look = rules.appearanceOf(material, geometry, warn);
      const reason = look ? null : rules.leavesOut(material);
      if (reason) {
        warn("transparent", reason, (end - start) / 3);
        continue;
      }
      /** @type {unknown} */ let plain;
      for (let i = start; i < end; i += 3) {
        if (look && (!look.covers || [0, 1, 2].some((corner) => look.covers?.(corners[i + corner])))) {
          painted.push({ triangle: keys.length, look, corners, at: i });
          keys.push(PAINTED);
        } else {
          plain ??= keyOf(material);
          keys.push(plain);
        }
        triangles.push(corners[i] + first, corners[i + 1] + first, corners[i + 2] + first);
      }
    }
    positions.push(place);
    const attribute = rules.normalsOf(mesh);
    if (attribute) normals.push([first, attribute]);
    first += count;
  }
  const all = new Float64Array(3 * first);
  let at = 0;
  for (const part of positions) {
    all.set(part, at);
    at += part.length;
  }
  const rows = Int32Array.from(triangles);
  return {
    positions: all,
    triangles: rows,
    keys,
    ...(painted.length && { surface: surfaceOf(painted, keys.length) }),
    ...(normals.length && { normals: { directions: joinedNormals(normals, first), rows } }),
  };
}

/** @param {BufferGeometry} geometry @param {number} count @returns {ArrayLike<number>} */
const cornersOf = ({ index }, count) =>
  index ? index.array.subarray(0, index.count) : Uint32Array.from({ length: count }, (_, i) => i);

/** Runs of one material: start, end, material. @param {ThreeMesh} mesh @param {number} corners @param {Warn} warn
 * @returns {[number, number, Material][]} */
function runsOf({ geometry, material }, corners, warn) {
  const whole = corners - (corners % 3);
  if (whole < corners)
    warn("incomplete-triangle", "corners after the last whole triangle of a primitive were left out");
  if (!Array.isArray(material)) return [[0, whole, material]];
  if (!geometry.groups.length) return [[0, whole, material[0]]];
  const endOf = (/** @type {{ start: number, count: number }} */ group) => Math.min(group.start + group.count, whole);
  return geometry.groups.map((group) => [group.start, endOf(group), material[group.materialIndex ?? 0]]);
}

/** The normals of all vertices, or zeros. @param {[number, Attribute][]} normals @param {number} count */
function joinedNormals(normals, count) {
  const single = normals.every(([, { array }]) => array instanceof Float32Array);
  const all = single ? new Float32Array(3 * count) : new Float64Array(3 * count);
  for (const [first, attribute] of normals)
    for (let i = 0, at = 3 * first; i < attribute.count; i++, at += 3) {
      all[at] = attribute.getX(i);
      all[at + 1] = attribute.getY(i);
      all[at + 2] = attribute.getZ(i);
    }
  return all;
}

/** @param {Painted[]} painted @param {number} count @returns {Surface} */ function surfaceOf(painted, count) {
  const entries = [...new Set(painted.map(({ look }) => look.entry))];
  const numbers = new Map(entries.map((entry, i) => [entry, i]));
  const rows = new Int32Array(count).fill(-1);
  const uv = new Float64Array(6 * count);
  const colours = new Float32Array(12 * count).fill(1);
  for (const { triangle, look, corners, at } of painted) {
    rows[triangle] = numbers.get(look.entry) ?? -1;
    for (let corner = 0; corner < 3; corner++) {
      look.uvOf?.(corners[at + corner], uv.subarray(6 * triangle + 2 * corner));
      look.colourOf?.(corners[at + corner], colours.subarray(12 * triangle + 4 * corner));
    }
  }
  return { entries, rows, uv, colours };
}

/** Whether morph targets or a skin move the vertices. @param {ThreeMesh} mesh */
export const isDeformed = (mesh) =>
  "isSkinnedMesh" in mesh || (mesh.morphTargetInfluences?.some((weight) => weight !== 0) ?? false);

/** @param {ThreeMesh} mesh @returns {ArrayLike<number>} */ function positionsOf(mesh) {
  const attribute = mesh.geometry.getAttribute("position");
  const deformed = isDeformed(mesh);
  if (!deformed && !("isInterleavedBufferAttribute" in attribute) && !attribute.normalized && attribute.itemSize === 3)
    return attribute.array.subarray(0, 3 * attribute.count);
  const positions = new Float64Array(3 * attribute.count);
  if ("isSkinnedMesh" in mesh) /** @type {SkinnedMesh} */ (mesh).skeleton.update();
  const point = mesh.position.clone();
  for (let i = 0; i < attribute.count; i++) {
    if (deformed) mesh.getVertexPosition(i, point);
    else point.set(attribute.getX(i), attribute.getY(i), attribute.getZ(i));
    point.toArray(positions, 3 * i);
  }
  return positions;
}
