// The way of one pixel's ray through the octree: a table of the words that it reads, and their octants over the picture.

import { $, element, svgElement } from "./elements.js";
import { BOX_EDGES, cornersOf, projection } from "./projection.js";
import { hex, isLeaf, material, octant } from "./voxrt/words.js";
/** @import { App } from "./app.js" @import { Registers, Size } from "./camera.js" */
/** @import { Followed, Reading } from "./voxrt/voxrt.js" */

const AXES = "xyz";
/** @typedef {Followed & { registers: Registers, size: Size, pixel: Size }} Way of a pixel's ray */

export class Inspector {
  /** @type {Way | null} */ #way = null;

  /** @param {App} app */ constructor(app) {
    this.app = app;
    $("ray-close").onclick = () => this.clear();
  }

  clear() {
    this.#way = null;
    $("ray").hidden = true;
    $("octants").replaceChildren();
  }

  /** @param {number} id */ #materialName = (id) => this.app.memory()?.materials[id]?.name ?? `material ${id}`;

  /** @param {Way} way */ show(way) {
    this.#way = way;
    const { readings, cell, material: id, face, pixel } = way;
    $("ray").hidden = false;
    const side = face < 3 ? `, through its ${AXES[face]} face` : "";
    const hit = cell ? `hits ${this.#materialName(id)} at voxel ${cell.join(", ")}${side}` : "hits nothing";
    $("ray-result").textContent = `Pixel ${pixel.join(", ")}: the ray reads ${readings.length} words and ${hit}.`;
    $("ray-rows").replaceChildren(...readings.map((reading, i) => this.#row(reading, readings[i + 1], i)));
    this.#draw();
    $("ray").scrollIntoView({ block: "nearest" });
  }

  /** @param {Reading} reading @param {Reading | undefined} next @param {number} i */ #row(reading, next, i) {
    const { address, word, level } = reading;
    const texts = [String(i + 1), String(address), hex(word), `${2 ** level}³`, this.#why(reading, next)];
    const line = element("tr", { tabIndex: 0 }, ...texts.map((text) => element("td", {}, text)));
    for (const type of ["pointerenter", "focus"]) line.addEventListener(type, () => this.#draw(i));
    for (const type of ["pointerleave", "blur"]) line.addEventListener(type, () => this.#draw());
    return line;
  }

  /** @param {Reading} reading @param {Reading | undefined} next */ #why({ word, level }, next) {
    if (!isLeaf(word)) {
      const target = next ? `octant ${octant(word, next.address)} of it` : "it";
      return `points to the block at ${word}: the ray goes down into ${target}`;
    }
    if (material(word)) return `solid: ${this.#materialName(material(word))}. The ray ends here`;
    if (!next) return "empty: the ray leaves the world";
    const axis = next.axis < 3 ? `the next plane across ${AXES[next.axis]}` : "its side";
    const up = next.level > level ? `, up to an octant of ${2 ** next.level}³` : "";
    return `empty: the ray leaves by ${axis}${up}`;
  }

  /** Draw the octants of all words read; the one of row `chosen` stands out. @param {number | null} chosen */
  #draw(chosen = null) {
    if (!this.#way) return;
    const { readings, registers, size, pixel } = this.#way;
    const [width, height] = size;
    $("octants").setAttribute("viewBox", `0 0 ${width} ${height}`);
    const paths = readings.flatMap((reading, i) => {
      const isHit = i === readings.length - 1 && material(reading.word) !== 0;
      const kind = i === chosen ? "chosen" : isHit ? "hit" : isLeaf(reading.word) ? "leaf" : "inner";
      const d = edgesOf(reading, registers, size);
      return d === null ? [] : [svgElement("path", { d, class: kind })];
    });
    const mark = { cx: pixel[0] + 0.5, cy: pixel[1] + 0.5, r: width / 160, class: "mark" };
    $("octants").replaceChildren(...paths, svgElement("circle", mark));
  }
}

/** The edges of an octant; null behind the eye. @param {Reading} reading @param {Registers} registers @param {Size}
 * size */
function edgesOf({ corner, level }, registers, size) {
  const high = corner.map((value) => value + 2 ** level);
  const places = cornersOf([corner, high]).map(projection(registers, size));
  if (places.some(({ far }) => far <= 0)) return null;
  const texts = places.map(({ x, y }) => [x, y].map((value) => value.toFixed(1)));
  return BOX_EDGES.map(([a, b]) => `M${texts[a]}L${texts[b]}`).join("");
}
