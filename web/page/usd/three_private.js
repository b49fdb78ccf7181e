// The private members of three.js' USD loader that the page replaces, calls or reads: all of them are named here. They are
// no interface, and change without notice: a test holds them against the release that is installed.

import { USDAParser } from "../three/addons/loaders/usd/USDAParser.js";
import { USDComposer } from "../three/addons/loaders/usd/USDComposer.js";
import { USDCParser } from "../three/addons/loaders/usd/USDCParser.js";
/** @import { Group, Object3D } from "three" @import { Attributes, Fields, Specs, Value } from "./stage.js" */

/** The REVISION of three.js with which the members were checked. */
export const CHECKED_RELEASE = "187";

/** @param {string} text */ const named = (text) => text.split(" ");

/** By class: methods that are replaced, methods that are called, and properties that are read. */
export const MEMBERS = {
  USDComposer: {
    class: USDComposer,
    replaced: [
      ...named("compose applyTransform _buildIndexes _buildHierarchy _buildMesh _buildGeomPrimitive _buildSkeleton"),
      ...named("_buildAnimations _findSingleMesh _getVariantPaths _resolveAttributeValue _resolveReference"),
    ],
    called: named("_flattenMatrixArray _getAttributes _resolveFilePath"),
    read: named("specsByPath childrenByPath attributesByPrimPath assets basePath"),
  },
  USDAParser: { class: USDAParser, replaced: named("parseText parseData _preprocess _extractPrimData") },
  USDCParser: {
    class: USDCParser,
    replaced: named("_readInlinedValue _readScalarValue _readArrayValue"),
    called: named("parseData _readHalf readUint8 readInt32 readUint32 readInt64 readUint64 readFloat64 seek tell"),
    read: named("reader tokens strings paths version buffer"),
  },
};

/** @typedef {{ specsByPath: Specs }} Parsed */

/** @typedef {{ specsByPath: Specs, childrenByPath: Map<string, { name: string, path: string }[]>,
 * attributesByPrimPath: Map<string, Map<string, unknown>>, assets: Record<string, Parsed |
 * Uint8Array<ArrayBuffer>>, basePath: string, compose: (parsed: Parsed, ...rest: unknown[]) => Group,
 * applyTransform: (object: Object3D, fields: Fields, attributes?: Attributes) => void, _buildIndexes: () => void,
 * _buildHierarchy: (parent: Object3D, path: string) => void, _buildMesh: (path: string, ...rest: unknown[]) =>
 * Object3D | null, _buildGeomPrimitive: (path: string, spec: unknown, kind: string) => Object3D | null,
 * _buildSkeleton: (path: string) => null, _buildAnimations: () => never[], _findSingleMesh: (group: Object3D) =>
 * Object3D | null, _getVariantPaths: (path: string) => string[], _resolveAttributeValue: (path: string) => Value |
 * undefined, _resolveReference: (reference: unknown) => null, _flattenMatrixArray: (matrices: unknown[], count:
 * number) => number[] | null, _getAttributes: (path: string) => Attributes, _resolveFilePath: (file: string) =>
 * string }} Composer */

/** Parsed text. @typedef {{ [key: string | symbol]: Data | string }} Data */
/** @typedef {Record<string, number>} SpecTypes */

/** @typedef {{ parseText: (text: string) => Data, parseData: (text: string) => Parsed, _preprocess: (text: string)
 * => string, _extractPrimData: (data: Data, path: string, fields: Fields, specs: Specs, types: SpecTypes) => void
 * }} TextParser */

/** @typedef {{ readUint8: () => number, readInt32: () => number, readUint32: () => number, readInt64: () => number,
 * readUint64: () => number, readFloat64: () => number, seek: (offset: number) => void, tell: () => number }}
 * BinaryReader */

/** @typedef {{ typeEnum: number, isCompressed: boolean, lo: number }} ValueRep */

/** @typedef {{ reader: BinaryReader, tokens: string[], strings: number[], paths: string[], version: { major: number,
 * minor: number }, buffer: ArrayBuffer, parseData: (buffer: ArrayBuffer) => Parsed, _readHalf: () => number,
 * _readInlinedValue: (rep: ValueRep) => unknown, _readScalarValue: (type: number) => unknown, _readArrayValue:
 * (rep: ValueRep) => unknown }} CrateParser */

/** Methods that replace some of a class. `kept` has those that they replace. @template C @typedef {(kept: C) =>
 * Partial<C> & ThisType<C>} MethodsOf */

/** Replace methods of a class, each time by more; returns what puts the old ones back. @template {object} C @param
 * {{ class: new () => C, replaced: string[] }} members @param {MethodsOf<C>[]} layers later ones stand before
 * earlier ones */
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
