// Concave polygons of OBJ files as triangles: OBJLoader cuts every polygon into a fan from its first corner, which is right
// for convex ones. A concave quadrilateral becomes a fan from its reflex corner, or from the one opposite to it; a concave
// polygon of more corners is cut by its ears, in its plane.

import { add, cross, dot, subtract } from "./vectors.js";
/** @import { Vector } from "./vectors.js" */

/** @typedef {number[]} Triangle three indices of corners */
/** @typedef {number[]} Point of a plane, two numbers */

const STRAIGHT = 1e-9; // a corner that turns back by less, of the square of the polygon's area, is straight

/** The text with these polygons replaced; all other lines stay. @param {string} text */
export function withoutConcave(text) {
  const lines = text.replace(/\\\r?\n/g, " ").split("\n");
  if (!lines.some((line) => /^\s*f\s/.test(line) && line.trim().split(/\s+/).length > 4)) return text;
  /** @type {number[][]} */ const places = [];
  const replaced = lines.map((line) => {
    const words = line.split("#")[0].trim().split(/\s+/);
    if (words[0] === "v") places.push(words.slice(1, 4).map(Number));
    if (words[0] !== "f" || words.length < 5) return line;
    const corners = words.slice(1);
    const points = corners.flatMap((corner) => {
      const point = places.at(Number.parseInt(corner, 10) - (corner.startsWith("-") ? 0 : 1));
      return point?.every(Number.isFinite) ? [point] : [];
    });
    if (points.length < corners.length) return line;
    const triangles = cutConcave(points);
    return triangles?.map((triangle) => `f ${triangle.map((at) => corners[at]).join(" ")}`).join("\n") ?? line;
  });
  return replaced.join("\n");
}

/** Triangles of a concave polygon; null for a convex one, or one without area. @param {Vector[]} corners @param
 * {(points: Point[]) => Triangle[] | null} [cut] the triangles of a polygon with more than four corners, which lies
 * in the plane, counter-clockwise */
export function cutConcave(corners, cut = ears) {
  const count = corners.length;
  const points = corners.map((corner) => subtract(corner, corners[0])); // near the origin, products keep their digits
  /** @param {number} i */ const next = (i) => points[(i + 1) % count];
  const normal = points.map((point, i) => cross(point, next(i))).reduce((sum, part) => add(part, sum), [0, 0, 0]);
  const least = -STRAIGHT * dot(normal, normal);
  const back = points.map((point, i) => {
    const before = points[(i + count - 1) % count];
    return dot(cross(subtract(point, before), subtract(next(i), point)), normal) < least;
  });
  if (!back.some(Boolean)) return null;
  const middle = [1, 2, 3];
  if (count === 4) return back[1] || back[3] ? [middle, [1, 3, 0]] : null;
  return cut(flat(points, normal));
}

/** Without the normal's longest axis, counter-clockwise. @param {Vector[]} points @param {Vector} normal */
function flat(points, normal) {
  const sizes = normal.map(Math.abs);
  const axis = sizes.indexOf(Math.max(...sizes));
  const [a, b] = normal[axis] < 0 ? [(axis + 2) % 3, (axis + 1) % 3] : [(axis + 1) % 3, (axis + 2) % 3];
  return points.map((point) => [point[a], point[b]]);
}

/** @param {Point} a @param {Point} b @param {Point} c */
const side = ([ax, ay], [bx, by], [cx, cy]) => (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);

/** Cuts off corners that hold no other one; null where a polygon crosses itself. @param {Point[]} points */
export function ears(points) {
  const left = points.map((_, i) => i);
  /** @type {Triangle[]} */ const triangles = [];
  while (left.length > 3) {
    const at = left.findIndex((_, i) => isEar(points, left, i));
    if (at < 0) return null;
    triangles.push(earAt(left, at));
    left.splice(at, 1);
  }
  return [...triangles, left];
}

/** @param {number[]} left @param {number} i */
const earAt = (left, i) => [-1, 0, 1].map((step) => left[(i + step + left.length) % left.length]);

/** @param {Point[]} points @param {number[]} left @param {number} i */ function isEar(points, left, i) {
  const [a, b, c] = earAt(left, i).map((at) => points[at]);
  if (side(a, b, c) <= 0) return false;
  return left.every((at) => {
    const point = points[at];
    if (point === a || point === b || point === c) return true;
    if ([a, b, c].some(([x, y]) => x === point[0] && y === point[1])) return true;
    return side(a, b, point) < 0 || side(b, c, point) < 0 || side(c, a, point) < 0;
  });
}
