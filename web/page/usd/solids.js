// Cubes, spheres, cylinders, cones, capsules and planes of USD as triangles: those of voxelize/primitive_meshes.py.

const SEGMENTS = 128;
/** @import { Value } from "./stage.js" */

/** @typedef {{ positions: number[], triangles: number[] }} Solid three numbers per vertex */
/** @typedef {[number, number]} Place of a profile: radius and height */
/** @type {Record<string, number>} */ const AXES = { X: 0, Y: 1, Z: 2 };

/** Lengths, each of some solids, and the axis of those that are not alike along all. @typedef {{ size: number,
 * radius: number, radiusBottom: number, radiusTop: number, height: number, width: number, length: number, axis:
 * string }} Dimensions */

/** @type {Record<string, number[]>} the axes of a plane */ const ACROSS = { X: [2, 1], Y: [0, 2], Z: [0, 1] };
const Z = { axis: "Z" };

/** @type {Record<string, { usual: Partial<Dimensions>, make: (dimensions: Dimensions) => Solid }>} the usual
 * dimensions */
const SOLIDS = {
  Cube: { usual: { size: 2 }, make: ({ size }) => cube(size) },
  Sphere: { usual: { radius: 1 }, make: ({ radius }) => revolved(arc(radius, -Math.PI / 2, Math.PI / 2, 0), Z.axis) },
  Cylinder: {
    usual: { radius: 1, height: 2, ...Z },
    make: ({ radius, height, axis }) => cylinder(radius, radius, height, axis),
  },
  Cylinder_1: {
    usual: { radiusBottom: 1, radiusTop: 1, height: 2, ...Z },
    make: ({ radiusBottom, radiusTop, height, axis }) => cylinder(radiusBottom, radiusTop, height, axis),
  },
  Cone: { usual: { radius: 1, height: 2, ...Z }, make: ({ radius, height, axis }) => cone(radius, height, axis) },
  Capsule: {
    usual: { radius: 0.5, height: 1, ...Z },
    make: ({ radius, height, axis }) => capsule(radius, radius, height, axis),
  },
  Capsule_1: {
    usual: { radiusBottom: 0.5, radiusTop: 0.5, height: 1, ...Z },
    make: ({ radiusBottom, radiusTop, height, axis }) => capsule(radiusBottom, radiusTop, height, axis),
  },
  Plane: { usual: { width: 2, length: 2, ...Z }, make: ({ width, length, axis }) => plane(width, length, axis) },
};

/** @param {string} kind */ export const isSolid = (kind) => Object.hasOwn(SOLIDS, kind);

/** The solids that the loader does not know. @param {string} kind */
export const isNewSolid = (kind) => ["Cylinder_1", "Capsule_1", "Plane"].includes(kind);

/** The values of a solid's dimensions. @param {string} kind @param {string} path @param {(name: string) => Value |
 * null} read the file's value, or null */
export function dimensionsOf(kind, path, read) {
  const { usual } = SOLIDS[kind];
  const values = Object.entries(usual).map(([name, plain]) => {
    const value = read(name) ?? plain;
    if (name === "axis" && !(String(value) in AXES))
      throw new Error(`${path}: axis '${value}' is not X, Y or Z; use one of them`);
    if (name !== "axis" && !(typeof value === "number" && value >= 0 && value < 1e60))
      throw new Error(`${path}: ${name} ${value} is not a length; use a positive number`);
    return [name, value];
  });
  return /** @type {Dimensions} */ (Object.fromEntries(values));
}

/** @param {string} kind @param {Dimensions} dimensions */
export const solidOf = (kind, dimensions) => SOLIDS[kind].make(dimensions);

/** @param {number} size */ function cube(size) {
  const positions = [-1, 1]
    .flatMap((z) => [-1, 1].flatMap((y) => [-1, 1].flatMap((x) => [x, y, z])))
    .map((part) => part * (size / 2));
  // biome-ignore format: the corners of each side
  const quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
  return { positions, triangles: quads.flatMap(([a, b, c, d]) => [a, b, c, a, c, d]) };
}

/** @param {number} width @param {number} length @param {string} axis */ function plane(width, length, axis) {
  const [across, along] = ACROSS[axis];
  const positions = new Array(12).fill(0);
  [
    [-1, -1],
    [1, -1],
    [1, 1],
    [-1, 1],
  ].forEach(([u, v], i) => {
    positions[3 * i + across] = (u * width) / 2;
    positions[3 * i + along] = (v * length) / 2;
  });
  return { positions, triangles: axis === "Z" ? [0, 1, 2, 0, 2, 3] : [2, 1, 0, 3, 2, 0] };
}

/** @type {(radii: number[], heights: number[]) => Place[]} */
const profile = (radii, heights) => radii.map((radius, i) => [radius, heights[i]]);

/** @param {number} bottom @param {number} top @param {number} height @param {string} axis */
function cylinder(bottom, top, height, axis) {
  const half = height / 2;
  return revolved(profile([0, bottom, top, 0], [-half, -half, half, half]), axis);
}

/** @param {number} radius @param {number} height @param {string} axis */ function cone(radius, height, axis) {
  return revolved(profile([0, radius, 0], [-height / 2, -height / 2, height / 2]), axis);
}

/** @param {number} bottom @param {number} top @param {number} height @param {string} axis */
const capsule = (bottom, top, height, axis) =>
  revolved([...arc(bottom, -Math.PI / 2, 0, -height / 2), ...arc(top, 0, Math.PI / 2, height / 2)], axis);

/** Part of a circle; a half turn has half of the segments. @param {number} radius @param {number} start @param
 * {number} stop @param {number} centre @returns {Place[]} */
function arc(radius, start, stop, centre) {
  const steps = Math.round((SEGMENTS * (stop - start)) / (2 * Math.PI));
  return Array.from({ length: steps + 1 }, (_, i) => {
    const angle = i === steps ? stop : start + i * ((stop - start) / steps);
    return [
      Math.abs(Math.abs(angle) - Math.PI / 2) < 1e-12 ? 0 : radius * Math.cos(angle),
      centre + radius * Math.sin(angle),
    ];
  });
}

/** @param {number} value */
const rounded = (value) => Math.round(value * 1e15) / 1e15; // exact zeros and ones on the axes

/** A surface of revolution; the ends of the profile have radius 0. @param {Place[]} profile @param {string} axis */
function revolved(profile, axis) {
  const turn = (AXES[axis] + 1) % 3;
  /** @type {number[]} */ const positions = [];
  /** @param {number} x @param {number} y @param {number} z */ const put = (x, y, z) => {
    const at = positions.length;
    positions.push(0, 0, 0);
    [x, y, z].forEach((part, i) => {
      positions[at + ((i + turn) % 3)] = part;
    });
  };
  put(0, 0, profile[0][1]);
  put(0, 0, profile[profile.length - 1][1]);
  const rings = profile.slice(1, -1);
  for (const [radius, height] of rings)
    for (let i = 0; i < SEGMENTS; i++) {
      const angle = (2 * Math.PI * i) / SEGMENTS;
      put(radius * rounded(Math.cos(angle)), radius * rounded(Math.sin(angle)), height);
    }
  const around = Array.from({ length: SEGMENTS }, (_, here) => [here, (here + 1) % SEGMENTS]);
  const triangles = around.flatMap(([here, there]) => [0, 2 + there, 2 + here]);
  for (let ring = 0; ring < rings.length - 1; ring++) {
    const [low, high] = [2 + ring * SEGMENTS, 2 + (ring + 1) * SEGMENTS];
    triangles.push(...around.flatMap(([here, there]) => [low + here, low + there, high + there]));
    triangles.push(...around.flatMap(([here, there]) => [low + here, high + there, high + here]));
  }
  const top = 2 + (rings.length - 1) * SEGMENTS;
  triangles.push(...around.flatMap(([here, there]) => [1, top + here, top + there]));
  return { positions, triangles };
}
