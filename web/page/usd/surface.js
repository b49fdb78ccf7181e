// The surface of a mesh of USD as triangles, each with its face and its corners, and values at these corners.

import { cutConcave, ears } from "../polygons.js";
import { dimensionsOf, solidOf } from "./solids.js";
import { attributeOf, numbersOf } from "./stage.js";
import { ShapeUtils, Vector2 } from "../three/three.core.js";

const FARTHEST = 1e60;
const [FEW_CORNERS, MOST_CORNERS] = [64, 20_000]; // of a concave polygon

/** @import { Numbers, Primvar } from "./stage.js" @import { Composer } from "./three_private.js" */
/** @import { Warn } from "../voxrt/warnings.js" */

/** Corners count those of all faces. `positions`: three numbers per vertex; `triangles`: three vertices per
 * triangle; `faces`: the face of each triangle; `corners`: three corners per triangle; `cornerCount`: 0 for solids.
 * @typedef {{ positions: Numbers, triangles: number[], faces: number[], faceCount: number, corners: number[],
 * cornerCount: number }} FaceSurface */

/** @typedef {(triangle: number, corner: number) => number} PlaceOf the first number of a corner */

/** The surface of a prim; null for no faces. @param {Composer} composer @param {string} path @param {string} kind
 * @param {Warn} warn @param {Numbers} [posed] points instead of the mesh's own */
export function surfaceOf(composer, path, kind, warn, posed) {
  if (kind === "Mesh") return meshSurface(composer, path, warn, posed);
  const dimensions = dimensionsOf(kind, path, (name) => attributeOf(composer, path, name));
  const { positions, triangles } = solidOf(kind, dimensions);
  const faces = new Array(triangles.length / 3).fill(0);
  return { positions, triangles, faces, faceCount: 1, corners: triangles, cornerCount: 0 };
}

/** @param {Composer} composer @param {string} path @param {Warn} warn @param {Numbers} [posed] */
function meshSurface(composer, path, warn, posed) {
  const positions = posed ?? numbersOf(composer, path, "points") ?? [];
  const [counts, corners, holes] = ["faceVertexCounts", "faceVertexIndices", "holeIndices"].map((name) =>
    integers(composer, path, name),
  );
  if (!counts.length || positions.length < 3) {
    warn("empty-mesh", "meshes without faces were left out");
    return null;
  }
  check(path, positions, counts, corners);
  if (attributeOf(composer, path, "subdivisionScheme") !== "none")
    warn("subdivision", "subdivision surfaces were replaced by their control cage");
  const hole = new Set(holes);
  const turned = attributeOf(composer, path, "orientation") === "leftHanded";
  /** @type {number[]} */ const triangles = [];
  /** @type {number[]} */ const faces = [];
  /** @type {number[]} */ const chosen = [];
  let start = 0;
  let thin = 0;
  for (let face = 0; face < counts.length; start += counts[face++]) {
    if (counts[face] < 3) thin++;
    if (counts[face] < 3 || hole.has(face)) continue;
    for (const cut of trianglesOf(path, positions, corners, start, counts[face])) {
      if (turned) cut.reverse();
      faces.push(face);
      for (const at of cut) {
        chosen.push(start + at);
        triangles.push(corners[start + at]);
      }
    }
  }
  if (thin) warn("degenerate-face", "faces of fewer than three corners were left out", thin);
  return { positions, triangles, faces, faceCount: counts.length, corners: chosen, cornerCount: corners.length };
}

/** @param {Composer} composer @param {string} path @param {string} name */ function integers(composer, path, name) {
  const values = numbersOf(composer, path, name) ?? [];
  if (typeof values === "string" || !Array.from(values).every(Number.isInteger))
    throw new Error(`${path}: ${name} holds values that are not integers; export it again`);
  return values;
}

/** @param {string} path @param {Numbers} positions @param {Numbers} counts @param {Numbers} corners */
function check(path, positions, counts, corners) {
  /** @param {string} problem */ const refuse = (problem) => {
    throw new Error(`${path}: ${problem}; export the mesh again`);
  };
  let wanted = 0;
  let negative = false;
  for (const count of counts) {
    wanted += count;
    negative ||= count < 0;
  }
  if (negative || wanted !== corners.length)
    refuse(`faceVertexCounts ask for ${wanted} corners and faceVertexIndices has ${corners.length}`);
  if (positions.length % 3) refuse("points holds values that are not points");
  const count = positions.length / 3;
  const wrong = Array.from(corners).find((corner) => !(corner >= 0 && corner < count));
  if (wrong !== undefined) refuse(`faceVertexIndices has ${wrong} and points has ${count}`);
  if (!Array.from(positions).every((part) => Math.abs(part) < FARTHEST))
    refuse("points has a coordinate that is not a finite number");
}

/** A fan from the first corner where a polygon is convex. @param {string} path @param {Numbers} positions @param
 * {Numbers} corners @param {number} start @param {number} count */
function trianglesOf(path, positions, corners, start, count) {
  if (count === 3) return [[0, 1, 2]];
  const points = Array.from({ length: count }, (_, i) =>
    [0, 1, 2].map((part) => positions[3 * corners[start + i] + part]),
  );
  const cut = cutConcave(points, (flat) => {
    if (count <= FEW_CORNERS) return ears(flat);
    if (count > MOST_CORNERS)
      throw new Error(`${path}: a concave polygon of ${count} corners is too large here; voxrt build takes it`);
    const contour = flat.map(([x, y]) => new Vector2(x, y));
    return ShapeUtils.triangulateShape(contour, []);
  });
  if (cut?.length === count - 2) return cut.map((triangle) => [...triangle]);
  return Array.from({ length: count - 2 }, (_, i) => [0, i + 1, i + 2]);
}

/** Where values of a primvar lie; null, with a warning, where there are not as many as the interpolation wants.
 * @param {string} name @param {Primvar} primvar @param {FaceSurface} surface @param {Warn} warn @returns {PlaceOf |
 * null} */
export function placesOf(name, { values, size, interpolation }, surface, warn) {
  const count = Math.floor(values.length / size);
  if (count === 1 || interpolation === "constant") return () => 0;
  /** @type {Record<string, [number, PlaceOf]>} how many values are wanted, and which is that of a corner */
  const kinds = {
    uniform: [surface.faceCount, (triangle) => surface.faces[triangle]],
    faceVarying: [surface.cornerCount, (triangle, corner) => surface.corners[3 * triangle + corner]],
    vertex: [surface.positions.length / 3, (triangle, corner) => surface.triangles[3 * triangle + corner]],
  };
  const [wanted, rowOf] = kinds[interpolation] ?? kinds.vertex;
  if (count !== wanted || (surface.cornerCount === 0 && interpolation !== "uniform")) {
    warn("primvar", `primvars '${name}' with a wrong number of values were ignored`);
    return null;
  }
  return (triangle, corner) => size * rowOf(triangle, corner);
}
