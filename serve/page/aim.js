// The frame on the face under the pointer, and the round of a brush.

import { $, svgElement } from "./elements.js";
import { projection } from "./projection.js";
import { add } from "./vectors.js";
/** @import { Registers } from "./camera.js" @import { Vector } from "./vectors.js" */

/** A voxel, and the empty one at its face. @typedef {{ voxel: number[], beside: number[] | null }} Picked */

const NEAR = 0.05; // voxels
const POINTS = 32; // of a round brush

/** Show a frame for what was picked; none for null. @param {Picked | null} picked @param {number} size voxels across
 * @param {{ width: number, height: number, camera: Registers } | null} frame the picture */
export function showAim(picked, size, frame) {
  const svg = document.getElementById("aim") ?? svgElement("svg", { id: "aim", "aria-hidden": "true" });
  if (!svg.isConnected) (document.getElementById("octants") ?? $("picture")).after(svg);
  svg.replaceChildren();
  if (!picked?.beside || !frame) return;
  svg.setAttribute("viewBox", `0 0 ${frame.width} ${frame.height}`);
  const project = projection(frame.camera, [frame.width, frame.height]);
  for (const outline of [faceOf(picked, picked.beside), ...(size > 1 ? [roundOf(picked, picked.beside, size)] : [])]) {
    const places = outline.map(project);
    if (places.some(({ far }) => far < NEAR)) continue;
    const points = places.map(({ x, y }) => `${x.toFixed(1)},${y.toFixed(1)}`).join(" ");
    svg.append(svgElement("polygon", { points, class: "under" }), svgElement("polygon", { points }));
  }
}

/** The axis of the face, and the two others. @param {Picked} picked @param {Vector} beside */
function axesOf({ voxel }, beside) {
  const axis = voxel.findIndex((place, i) => place !== beside[i]);
  return [axis, (axis + 1) % 3, (axis + 2) % 3];
}

/** A place of the face's plane. @param {Picked} picked @param {Vector} beside @param {number} a @param {number} b */
function onFace(picked, beside, a, b) {
  const [axis, first, second] = axesOf(picked, beside);
  const place = [...picked.voxel];
  place[axis] += beside[axis] > picked.voxel[axis] ? 1 : 0;
  place[first] += a;
  place[second] += b;
  return place;
}

/** @param {Picked} picked @param {Vector} beside */ const faceOf = (picked, beside) =>
  [
    [0, 0],
    [1, 0],
    [1, 1],
    [0, 1],
  ].map(([a, b]) => onFace(picked, beside, a, b));

/** @param {Picked} picked @param {Vector} beside @param {number} size */ const roundOf = (picked, beside, size) =>
  Array.from({ length: POINTS }, (_, i) => {
    const angle = (2 * Math.PI * i) / POINTS;
    return add(
      onFace(picked, beside, 0.5 + (size / 2) * Math.cos(angle), 0.5 + (size / 2) * Math.sin(angle)),
      [0, 0, 0],
    );
  });
