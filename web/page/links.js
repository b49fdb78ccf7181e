// Links to a scene and its view: the part of an address after "#". The scene is an example, a file at the address of
// ?model=, or a packed memory.

import { cameraText, numbersOf, readCamera } from "./camera_text.js";
import { FILLS, RULES } from "./voxrt/voxrt.js";
/** @import { Placed } from "./camera_text.js" @import { Placing } from "./placing.js" */
/** @import { Daylight, Fill, Rule } from "./voxrt/voxrt.js" */

/** `memory`: packed. @typedef {Placing & { scene?: string | null, memory?: string | null, depth: number | null, bake:
 * Daylight | null, words: number | null, fill: Fill, rule: Rule, camera: Placed | null }} Link */

/** @type {Link} */ const PLAIN = {
  depth: null,
  bake: null,
  words: null,
  up: null,
  unit: null,
  fill: "auto",
  rule: "touch",
  camera: null,
};
export const LONGEST = 32_000; // characters: some programs cut longer ones
export const LONGEST_UNPACKED = 4 * 2 ** 20; // bytes of a memory that a link carries

/** @param {Partial<Link>} link */ export function linkOf(link) {
  const { scene, memory, depth, bake, words, up, unit, fill, rule, camera } = { ...PLAIN, ...link };
  const fields = {
    scene,
    depth,
    bake: bake && [...bake.sun, bake.sky[0], bake.samples].join(","),
    words,
    up,
    unit,
    fill: fill === "auto" ? null : fill,
    rule: rule === "touch" ? null : rule,
    camera: camera && cameraText(camera),
    memory,
  };
  const known = Object.entries(fields).flatMap(([name, value]) => (value ? [[name, String(value)]] : []));
  return `#${new URLSearchParams(known)}`;
}

/** The fields of a link. Throws an error for what is not in order. @param {string} hash @returns {Link} */
export function readLink(hash) {
  /** @type {Link} */ const link = { ...PLAIN };
  for (const [name, text] of new URLSearchParams(hash.slice(1))) {
    const parts = numbersOf(text);
    /** @param {number} length */ const isList = (length) => parts.length === length && parts.every(Number.isFinite);
    /** @param {number} low @param {number} high */ const isWhole = (low, high) =>
      isList(1) && Number.isInteger(parts[0]) && parts[0] >= low && parts[0] <= high;
    if (name === "scene" || name === "memory") link[name] = text;
    else if (name === "depth" && isWhole(3, 12)) link.depth = parts[0];
    else if (name === "words" && isWhole(1, 2 ** 32 - 1)) link.words = parts[0];
    else if (name === "up" && (text === "y" || text === "z")) link.up = text;
    else if (name === "unit" && isList(1) && parts[0] > 0) link.unit = parts[0];
    else if (name === "fill" && isFill(text)) link.fill = text;
    else if (name === "rule" && isRule(text)) link.rule = text;
    else if (name === "bake" && isDaylight(parts, isList)) link.bake = daylightOf(parts);
    else if (name === "camera" && readCamera(text)) link.camera = readCamera(text);
    else throw new Error(`its part ${JSON.stringify(`${name}=${text}`.slice(0, 40))} is not known here`);
  }
  return link;
}

/** @param {string} text @returns {text is Rule} */
const isRule = (text) => /** @type {readonly string[]} */ (RULES).includes(text);

/** @param {string} text @returns {text is Fill} */
const isFill = (text) => /** @type {readonly string[]} */ (FILLS).includes(text);

/** @param {number[]} parts @param {(length: number) => boolean} isList */
function isDaylight(parts, isList) {
  const [level, samples] = parts.slice(3);
  return isList(5) && level >= 0 && level <= 16 && Number.isInteger(samples) && samples >= 1 && samples <= 4096;
}

/** @param {number[]} parts */
const daylightOf = ([x, y, z, level, samples]) => ({ sun: [x, y, z], sky: [level, level, level], samples });
