// The manifest beside a .mem: what it says is checked as voxrt does, and used.

import { crc32 } from "./crc32.js";

const DAMAGED = "it is no manifest of a memory, or damaged: build it again";
const HIGHEST = 2 ** 31 - 1;

const isWhole = (low, high) => (value) => Number.isInteger(value) && value >= low && value <= high;
const isList = (length, is) => (value) =>
  Array.isArray(value) && (length === null || value.length === length) && value.every(is);
const isByte = isWhole(0, 255);
const isPlace = isList(3, isWhole(-HIGHEST, HIGHEST));
const isFlag = (value) => typeof value === "boolean";
const isObject = (value) => typeof value === "object" && value !== null && !Array.isArray(value);
const isNone = (value) => value === null || value === undefined;
const isMaterial = (value, id) =>
  isObject(value) &&
  value.id === id &&
  typeof value.name === "string" &&
  isList(3, isByte)(value.colour) &&
  isFlag(value.mirror) &&
  isFlag(value.authored);
const isWorld = (value) => isObject(value) && isList(3, Number.isFinite)(value.origin) && value.voxel_size > 0;
const isView = (value) => isObject(value) && ["position", "look", "right", "up"].every((name) => isPlace(value[name]));
const isAnimation = (value) =>
  isObject(value) && isList(null, (frame) => isWhole(0, 2 ** 32)(frame?.root))(value.frames) && value.frames.length > 0;

const LIGHTING = {
  position: isPlace,
  ambient: isByte,
  on: isFlag,
  flat: isFlag,
  bounces: isWhole(0, 15),
  faces: (value) => value === null || isList(6, isByte)(value),
};
const isLighting = (value) =>
  isObject(value) && Object.entries(LIGHTING).every(([name, is]) => value[name] === undefined || is(value[name]));

const FIELDS = {
  depth: isWhole(1, 16),
  words: isWhole(1, 2 ** 32),
  materials: (value) =>
    isList(null, isObject)(value) && value.length >= 1 && value.length <= 256 && value.every(isMaterial),
  objects: isList(null, isObject),
  warnings: isList(null, isObject),
  world: (value) => isNone(value) || isWorld(value),
  lighting: (value) => isNone(value) || isLighting(value),
  view: (value) => isNone(value) || isView(value),
  animation: (value) => isNone(value) || isAnimation(value),
};

// Read a manifest ({name, bytes}) that describes a .mem ({name, bytes}).
export function readManifest(file, mem) {
  const refuse = (problem) => {
    throw new Error(`${mem.name}: ${file.name}: ${problem}`);
  };
  let known;
  try {
    known = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(file.bytes));
  } catch {
    refuse(DAMAGED);
  }
  if (!isObject(known)) refuse(DAMAGED);
  if (known.schema !== 1) refuse(`schema ${JSON.stringify(known.schema)} is not known to this page (1)`);
  for (const [name, is] of Object.entries(FIELDS)) if (!is(known[name])) refuse(`$.${name} is not valid; ${DAMAGED}`);
  const crc = crc32(mem.bytes).toString(16).toUpperCase().padStart(8, "0");
  if (known.crc32 !== crc)
    refuse(
      `describes another ${mem.name} (CRC-32 ${crc} is not the one it names); build both again, or leave the manifest out`,
    );
  if (known.dialect !== "report")
    refuse(
      `the dialect ${JSON.stringify(known.dialect)} is not read here; voxrt convert --dialect report makes one that is`,
    );
  return known;
}
