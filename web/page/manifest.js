// The manifest beside a .mem: what it says is checked as voxrt does, and used.

import { crc32 } from "./crc32.js";
import { DIALECT, hex } from "./voxrt/words.js";

const DAMAGED = "it is no manifest of a memory, or damaged: build it again";
const HIGHEST = 2 ** 31 - 1;

/** @import { Registers } from "./camera.js" @import { DroppedFile } from "./folder.js" */
/** @import { Lighting } from "./memory.js" @import { Material, Warning } from "./voxrt/voxrt.js" */

/** What is used of a manifest. @typedef {{ depth: number, words: number, materials: Required<Material>[], objects:
 * object[], warnings: Warning[], world?: { origin: number[], voxel_size: number } | null, lighting?:
 * Partial<Lighting> | null, view?: Registers | null, animation?: { frames: object[] } | null }} Manifest */

/** @typedef {(value: unknown) => boolean} Check */

/** @param {number} low @param {number} high @returns {Check} */ const isWhole = (low, high) => (value) =>
  typeof value === "number" && Number.isInteger(value) && value >= low && value <= high;

/** @param {Check} is @param {number} [length] @returns {Check} */ const isList = (is, length) => (value) =>
  Array.isArray(value) && (length === undefined || value.length === length) && value.every((one) => is(one));

/** @param {unknown} value @returns {value is Record<string, unknown>} */
const isObject = (value) => typeof value === "object" && value !== null && !Array.isArray(value);
const isByte = isWhole(0, 255);
const isPlace = isList(isWhole(-HIGHEST, HIGHEST), 3);
/** @type {Check} */ const isFlag = (value) => typeof value === "boolean";
/** @param {Check} is @returns {Check} */
const isOptional = (is) => (value) => value === null || value === undefined || is(value);
/** @type {Check} */ const isMaterial = (value) =>
  isObject(value) &&
  typeof value.name === "string" &&
  isList(isByte, 3)(value.colour) &&
  isFlag(value.mirror) &&
  isFlag(value.authored);
/** @type {Check} */ const isMaterials = (value) =>
  Array.isArray(value) &&
  value.length >= 1 &&
  value.length <= 256 &&
  value.every((one, id) => isMaterial(one) && one.id === id);
/** @type {Check} */ const isWorld = (value) =>
  isObject(value) &&
  isList(Number.isFinite, 3)(value.origin) &&
  typeof value.voxel_size === "number" &&
  value.voxel_size > 0;
/** @type {Check} */
const isView = (value) => isObject(value) && ["position", "look", "right", "up"].every((name) => isPlace(value[name]));
/** @type {Check} */ const isFrame = (value) => isObject(value) && isWhole(0, 2 ** 32)(value.root);
/** @type {Check} */ const isAnimation = (value) =>
  isObject(value) && isList(isFrame)(value.frames) && Array.isArray(value.frames) && value.frames.length > 0;

/** @type {Record<string, Check>} */ const LIGHTING = {
  position: isPlace,
  ambient: isByte,
  on: isFlag,
  flat: isFlag,
  bounces: isWhole(0, 15),
  faces: (value) => value === null || isList(isByte, 6)(value),
};
/** @type {Check} */ const isLighting = (value) =>
  isObject(value) && Object.entries(LIGHTING).every(([name, is]) => value[name] === undefined || is(value[name]));

/** @type {Record<string, Check>} */ const FIELDS = {
  depth: isWhole(1, 16),
  words: isWhole(1, 2 ** 32),
  materials: isMaterials,
  objects: isList(isObject),
  warnings: isList(isObject),
  world: isOptional(isWorld),
  lighting: isOptional(isLighting),
  view: isOptional(isView),
  animation: isOptional(isAnimation),
};

/** Read the manifest that describes a memory. @param {DroppedFile} file @param {DroppedFile} mem */
export function readManifest(file, mem) {
  /** @param {string} problem */ const fault = (problem) => new Error(`${mem.name}: ${file.name}: ${problem}`);
  /** @type {unknown} */ let known;
  try {
    known = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(file.bytes));
  } catch {
    throw fault(DAMAGED);
  }
  if (!isObject(known)) throw fault(DAMAGED);
  if (known.schema !== 1) throw fault(`schema ${JSON.stringify(known.schema)} is not known to this page (1)`);
  for (const [name, is] of Object.entries(FIELDS))
    if (!is(known[name])) throw fault(`$.${name} is not valid; ${DAMAGED}`);
  const crc = hex(crc32(mem.bytes));
  if (known.crc32 !== crc) {
    const advice = "build both again, or leave the manifest out";
    throw fault(`describes another ${mem.name} (CRC-32 ${crc} is not the one it names); ${advice}`);
  }
  if (known.dialect !== DIALECT) {
    const advice = `voxrt convert --dialect ${DIALECT} makes one that is`;
    throw fault(`the dialect ${JSON.stringify(known.dialect)} is not read here; ${advice}`);
  }
  return /** @type {Manifest} */ (/** @type {unknown} */ (known));
}
