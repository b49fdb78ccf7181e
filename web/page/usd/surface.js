// The surface of a mesh of USD as triangles, each with its face and its corners, and values at these corners.

import { cutConcave, ears } from "../polygons.js";
import { dimensionsOf, solidOf } from "./solids.js";
import { valueOf } from "./stage.js";
import { ShapeUtils, Vector2 } from "../three/three.core.js";

const FARTHEST = 1e70;
const [FEW_CORNERS, MOST_CORNERS] = [64, 20_000]; // of a concave polygon

// {positions, triangles, faces, faceCount, corners, cornerCount}: three numbers per vertex; three vertices, a face and three
// corners per triangle, where corners count those of all faces; cornerCount is 0 for solids. null for no faces. `posed`: points instead of the mesh's own.
export function surfaceOf(composer, path, kind, warn, posed) {
  if (kind === "Mesh") return meshSurface(composer, path, warn, posed);
  const { positions, triangles } = solidOf(
    kind,
    dimensionsOf(kind, path, (name) => valueOf(composer, path, name)),
  );
  return {
    positions,
    triangles,
    faces: new Array(triangles.length / 3).fill(0),
    faceCount: 1,
    corners: triangles,
    cornerCount: 0,
  };
}

function meshSurface(composer, path, warn, posed) {
  const positions = posed ?? valueOf(composer, path, "points") ?? [];
  const [counts, corners, holes] = ["faceVertexCounts", "faceVertexIndices", "holeIndices"].map((name) =>
    integers(composer, path, name),
  );
  if (!counts.length || positions.length < 3) {
    warn("empty-mesh", "meshes without faces were left out");
    return null;
  }
  check(path, positions, counts, corners);
  if (valueOf(composer, path, "subdivisionScheme") !== "none")
    warn("subdivision", "subdivision surfaces were replaced by their control cage");
  const hole = new Set(holes);
  const turned = valueOf(composer, path, "orientation") === "leftHanded";
  const [triangles, faces, chosen] = [[], [], []];
  let start = 0;
  let thin = 0;
  for (let face = 0; face < counts.length; start += counts[face++]) {
    thin += counts[face] < 3;
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

function integers(composer, path, name) {
  const values = valueOf(composer, path, name) ?? [];
  if (typeof values === "string" || !Array.from(values).every(Number.isInteger))
    throw new Error(`${path}: ${name} holds values that are not integers; export it again`);
  return values;
}

function check(path, positions, counts, corners) {
  const refuse = (problem) => {
    throw new Error(`${path}: ${problem}; export the mesh again`);
  };
  let asked = 0;
  let negative = false;
  for (const count of counts) {
    asked += count;
    negative ||= count < 0;
  }
  if (negative || asked !== corners.length)
    refuse(`faceVertexCounts ask for ${asked} corners and faceVertexIndices has ${corners.length}`);
  if (positions.length % 3) refuse("points holds values that are not points");
  const count = positions.length / 3;
  const wrong = corners.find((corner) => !(corner >= 0 && corner < count));
  if (wrong !== undefined) refuse(`faceVertexIndices has ${wrong} and points has ${count}`);
  if (!positions.every((part) => Math.abs(part) < FARTHEST))
    refuse("points has a coordinate that is not a finite number");
}

// A fan from the first corner where a polygon is convex.
function trianglesOf(path, positions, corners, start, count) {
  if (count === 3) return [[0, 1, 2]];
  const points = Array.from({ length: count }, (_, i) =>
    [0, 1, 2].map((part) => positions[3 * corners[start + i] + part]),
  );
  const cut = cutConcave(points, (flat) => {
    if (count <= FEW_CORNERS) return ears(flat);
    if (count > MOST_CORNERS)
      throw new Error(`${path}: a concave polygon of ${count} corners is too large here; voxrt build takes it`);
    return ShapeUtils.triangulateShape(
      flat.map(([x, y]) => new Vector2(x, y)),
      [],
    );
  });
  if (cut?.length === count - 2) return cut.map((triangle) => [...triangle]);
  return Array.from({ length: count - 2 }, (_, i) => [0, i + 1, i + 2]);
}

// Where values of a primvar lie: a function of a triangle and its corner, 0 … 2, that gives the first number's place; null,
// with a warning, where there are not as many as the interpolation wants.
export function placesOf(name, { values, size, interpolation }, surface, warn) {
  const count = Math.floor(values.length / size);
  if (count === 1 || interpolation === "constant") return () => 0;
  const [wanted, rowOf] = {
    uniform: [surface.faceCount, (triangle) => surface.faces[triangle]],
    faceVarying: [surface.cornerCount, (triangle, corner) => surface.corners[3 * triangle + corner]],
  }[interpolation] ?? [surface.positions.length / 3, (triangle, corner) => surface.triangles[3 * triangle + corner]];
  if (count !== wanted || (surface.cornerCount === 0 && interpolation !== "uniform")) {
    warn("primvar", `primvars '${name}' with a wrong number of values were ignored`);
    return null;
  }
  return (triangle, corner) => size * rowOf(triangle, corner);
}
