// The private members of three.js' USD loader that the page replaces, calls or reads: all of them are named here. They are
// no interface, and change without notice: a test holds them against the release that is installed.

import { USDAParser } from "../three/addons/loaders/usd/USDAParser.js";
import { USDComposer } from "../three/addons/loaders/usd/USDComposer.js";
import { USDCParser } from "../three/addons/loaders/usd/USDCParser.js";

/** @import { Group, Object3D } from "three" */
/** @import { Attributes, Fields, Specs, Value } from "./stage.js" */

/** The REVISION of three.js with which the members were checked. */
export const CHECKED_RELEASE = "187";

/** By class: methods that are replaced, others that are called, and properties that are read. */
export const MEMBERS = {
  USDComposer: {
    class: USDComposer,
    replaced: [
      "compose",
      "applyTransform",
      "_buildIndexes",
      "_buildHierarchy",
      "_buildMesh",
      "_buildGeomPrimitive",
      "_buildSkeleton",
      "_buildAnimations",
      "_findSingleMesh",
      "_getVariantPaths",
      "_resolveAttributeValue",
      "_resolveReference",
    ],
    called: ["_flattenMatrixArray", "_getAttributes", "_resolveFilePath"],
    read: ["specsByPath", "childrenByPath", "attributesByPrimPath", "assets", "basePath"],
  },
  USDAParser: {
    class: USDAParser,
    replaced: ["parseText", "parseData", "_preprocess", "_extractPrimData"],
    called: [],
    read: [],
  },
  USDCParser: {
    class: USDCParser,
    replaced: ["_readInlinedValue", "_readScalarValue", "_readArrayValue"],
    called: ["parseData", "_readHalf"],
    read: ["reader", "tokens", "strings", "paths", "version", "buffer"],
  },
};

/** The methods of USDCParser's `reader` that are called. */
export const READER = [
  "readUint8",
  "readInt32",
  "readUint32",
  "readInt64",
  "readUint64",
  "readFloat64",
  "seek",
  "tell",
];

/** @typedef {{ specsByPath: Specs }} Parsed */

/**
 * @typedef {object} Composer
 * @property {Specs} specsByPath
 * @property {Map<string, { name: string, path: string }[]>} childrenByPath
 * @property {Map<string, Map<string, unknown>>} attributesByPrimPath
 * @property {Record<string, Parsed | Uint8Array<ArrayBuffer>>} assets
 * @property {string} basePath
 * @property {(parsed: Parsed, ...rest: unknown[]) => Group} compose
 * @property {(object: Object3D, fields: Fields, attributes?: Attributes) => void} applyTransform
 * @property {() => void} _buildIndexes
 * @property {(parent: Object3D, path: string) => void} _buildHierarchy
 * @property {(path: string, ...rest: unknown[]) => Object3D | null} _buildMesh
 * @property {(path: string, spec: unknown, kind: string) => Object3D | null} _buildGeomPrimitive
 * @property {(path: string) => null} _buildSkeleton
 * @property {() => never[]} _buildAnimations
 * @property {(group: Object3D) => Object3D | null} _findSingleMesh
 * @property {(path: string) => string[]} _getVariantPaths
 * @property {(path: string) => Value | undefined} _resolveAttributeValue
 * @property {(reference: unknown) => null} _resolveReference
 * @property {(matrices: unknown[], count: number) => number[] | null} _flattenMatrixArray
 * @property {(path: string) => Attributes} _getAttributes
 * @property {(file: string) => string} _resolveFilePath
 */

/** Text as the parser has it: values by what stands before "=" or "{". @typedef {{ [key: string | symbol]: Data | string }} Data */
/** @typedef {Record<string, number>} SpecTypes */

/**
 * @typedef {object} TextParser
 * @property {(text: string) => Data} parseText
 * @property {(text: string) => Parsed} parseData
 * @property {(text: string) => string} _preprocess
 * @property {(data: Data, path: string, fields: Fields, specs: Specs, types: SpecTypes) => void} _extractPrimData
 */

/**
 * @typedef {object} BinaryReader
 * @property {() => number} readUint8
 * @property {() => number} readInt32
 * @property {() => number} readUint32
 * @property {() => number} readInt64
 * @property {() => number} readUint64
 * @property {() => number} readFloat64
 * @property {(offset: number) => void} seek
 * @property {() => number} tell
 */

/** @typedef {{ typeEnum: number, isCompressed: boolean, lo: number }} ValueRep */

/**
 * @typedef {object} CrateParser
 * @property {BinaryReader} reader
 * @property {string[]} tokens
 * @property {number[]} strings
 * @property {string[]} paths
 * @property {{ major: number, minor: number }} version
 * @property {ArrayBuffer} buffer
 * @property {(buffer: ArrayBuffer) => Parsed} parseData
 * @property {() => number} _readHalf
 * @property {(rep: ValueRep) => unknown} _readInlinedValue
 * @property {(type: number) => unknown} _readScalarValue
 * @property {(rep: ValueRep) => unknown} _readArrayValue
 */

/**
 * Methods that replace some of a class. `kept` has those that they replace.
 * @template C
 * @typedef {(kept: C) => Partial<C> & ThisType<C>} MethodsOf
 */

/**
 * Replace methods of a class, each time by more; returns what puts the old ones back.
 * @template {object} C
 * @param {{ class: new () => C, replaced: string[] }} members
 * @param {MethodsOf<C>[]} layers later ones stand before earlier ones
 */
export function patch({ class: { prototype }, replaced }, layers) {
  const methodsNow = () => {
    const found = replaced.map((name) => [name, Object.getOwnPropertyDescriptor(prototype, name)?.value]);
    return /** @type {C} */ (Object.fromEntries(found));
  };
  const first = methodsNow();
  for (const methodsOf of layers) {
    const methods = methodsOf(methodsNow());
    const unknown = Object.keys(methods).find((name) => !replaced.includes(name));
    if (unknown) throw new Error(`${unknown} is not among the private members of three.js in three_private.js`);
    Object.assign(prototype, methods);
  }
  return () => Object.assign(prototype, first);
}
