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
/** @type {Check} */ const isEmpty = (value) => Array.isArray(value) && value.length === 0;
/** @param {Check} is @returns {Check} */ const isKnown = (is) => (value) => value === undefined || is(value);
/** @param {Check} is @returns {Check} */
const isOptional = (is) => (value) => value === null || value === undefined || is(value);
/** @param {Record<string, Check>} fields @returns {Check} */ const isShape = (fields) => (value) =>
  isObject(value) && Object.entries(fields).every(([name, is]) => is(value[name]));

/** @type {Check} */ const isText = (value) => typeof value === "string";
/** @type {Check} */ const isSize = (value) => typeof value === "number" && value > 0;
/** @type {Check} */ const isFaces = (value) => value === null || isList(isByte, 6)(value);
const isMaterial = isShape({ name: isText, colour: isList(isByte, 3), mirror: isFlag, authored: isFlag });
/** @type {Check} */ const isMaterials = (value) =>
  Array.isArray(value) && isWhole(1, 256)(value.length) && value.every((one, id) => isMaterial(one) && one.id === id);
const isWorld = isShape({ origin: isList(Number.isFinite, 3), voxel_size: isSize });
const isView = isShape({ position: isPlace, look: isPlace, right: isPlace, up: isPlace });
const isFrames = isList(isShape({ root: isWhole(0, 2 ** 32) }));
const isAnimation = isShape({ frames: (value) => isFrames(value) && !isEmpty(value) });
const LIGHTING = {
  position: isPlace,
  ambient: isByte,
  on: isFlag,
  flat: isFlag,
  bounces: isWhole(0, 15),
  faces: isFaces,
};
const isLighting = isShape(Object.fromEntries(Object.entries(LIGHTING).map(([name, is]) => [name, isKnown(is)])));

/** @type {Record<string, Check>} */ const FIELDS = {
  depth: isWhole(1, 16),
  words: isWhole(1, 2 ** 32),
  materials: isMaterials,
  objects: isList(isObject),
  warnings: isList(isShape({ kind: isText, message: isText, count: isKnown(isWhole(0, HIGHEST)) })),
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
