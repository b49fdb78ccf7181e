// The way of one pixel's ray through the octree: a table of the words that it reads, and their octants over the picture.

import { $ } from "./elements.js";
import { dot, subtract } from "./vectors.js";

const AXES = "xyz";
const EDGES = [
  [0, 1],
  [2, 3],
  [4, 5],
  [6, 7],
  [0, 2],
  [1, 3],
  [4, 6],
  [5, 7],
  [0, 4],
  [1, 5],
  [2, 6],
  [3, 7],
];
const SVG = "http://www.w3.org/2000/svg";
const hex = (word) => word.toString(16).toUpperCase().padStart(8, "0");
const isLeaf = (word) => word >= 0x80000000;

// `app` is that of main.js.
export class Inspector {
  constructor(app) {
    this.app = app;
    this.drawing = $("octants");
    this.path = null;
    $("ray-close").onclick = () => this.clear();
  }

  clear() {
    this.path = null;
    $("ray").hidden = true;
    this.drawing.replaceChildren();
  }

  // Show the ray of pixel (column, row): what `followed` read, with the camera's registers and the frame's size.
  show(followed, registers, size, pixel) {
    this.path = { ...followed, registers, size, pixel };
    const { readings, cell, material, face } = followed;
    const { materials } = this.app.memory();
    $("ray").hidden = false;
    const hit = cell
      ? `hits ${materials[material]?.name ?? `material ${material}`} at voxel ${cell.join(", ")}${face < 3 ? `, through its ${AXES[face]} face` : ""}`
      : "hits nothing";
    $("ray-result").textContent = `Pixel ${pixel.join(", ")}: the ray reads ${readings.length} words and ${hit}.`;
    $("ray-rows").replaceChildren(...readings.map((reading, i) => this.row(reading, readings[i + 1], i)));
    this.draw();
    $("ray").scrollIntoView({ block: "nearest" });
  }

  row(reading, next, i) {
    const line = document.createElement("tr");
    const cells = [
      String(i + 1),
      String(reading.address),
      hex(reading.word),
      `${2 ** reading.level}³`,
      this.why(reading, next),
    ];
    line.append(...cells.map((text) => Object.assign(document.createElement("td"), { textContent: text })));
    line.tabIndex = 0;
    for (const type of ["pointerenter", "focus"]) line.addEventListener(type, () => this.draw(i));
    for (const type of ["pointerleave", "blur"]) line.addEventListener(type, () => this.draw());
    return line;
  }

  why({ word, level }, next) {
    if (!isLeaf(word))
      return `points to the block at ${word}: the ray goes down into ${next ? `octant ${(next.address - word) & 7} of it` : "it"}`;
    if (word & 255)
      return `solid: ${this.app.memory().materials[word & 255]?.name ?? `material ${word & 255}`}. The ray ends here`;
    if (!next) return "empty: the ray leaves the world";
    const axis = next.axis < 3 ? `the next plane across ${AXES[next.axis]}` : "its side";
    return `empty: the ray leaves by ${axis}${next.level > level ? `, up to an octant of ${2 ** next.level}³` : ""}`;
  }

  // Draw the octants of all words read; the one of row `chosen` stands out.
  draw(chosen = null) {
    if (!this.path) return;
    const { readings, registers, size, pixel } = this.path;
    const [width, height] = size;
    this.drawing.setAttribute("viewBox", `0 0 ${width} ${height}`);
    const cubes = readings
      .map((reading, i) => this.cube(reading, registers, size, i === chosen, i === readings.length - 1))
      .filter(Boolean);
    const mark = document.createElementNS(SVG, "circle");
    for (const [name, value] of Object.entries({
      cx: pixel[0] + 0.5,
      cy: pixel[1] + 0.5,
      r: width / 160,
      class: "mark",
    }))
      mark.setAttribute(name, value);
    this.drawing.replaceChildren(...cubes, mark);
  }

  cube({ corner, level, word }, { position, look, right, up }, [width, height], chosen, last) {
    const side = 2 ** level;
    const eye = position.map((value) => value / 16);
    const places = Array.from({ length: 8 }, (_, i) => {
      const away = subtract(
        corner.map((value, axis) => value + ((i >> axis) & 1) * side),
        eye,
      );
      const far = dot(away, look) / dot(look, look);
      const at = (axis) => dot(away, axis) / dot(axis, axis) / far;
      return far > 1e-9 ? [Math.floor(width / 2) + at(right) + 0.5, Math.floor(height / 2) - at(up) + 0.5] : null;
    });
    if (places.includes(null)) return null; // behind the eye
    const path = document.createElementNS(SVG, "path");
    path.setAttribute(
      "d",
      EDGES.map(([a, b]) => `M${places[a].map((v) => v.toFixed(1))}L${places[b].map((v) => v.toFixed(1))}`).join(""),
    );
    path.setAttribute("class", chosen ? "chosen" : last && word & 255 ? "hit" : isLeaf(word) ? "leaf" : "inner");
    return path;
  }
}
