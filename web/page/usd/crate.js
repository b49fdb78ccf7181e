// Binary USD files: types of values that the parser of three.js' loader leaves out.

const [BOOL, UCHAR, INT64, UINT64, MATRIX_3D, QUATD, QUATH] = [1, 2, 5, 6, 14, 16, 18];
const [VEC_2D, VEC_2H, VEC_2I, VEC_3D, VEC_3H, VEC_3I, VEC_4D, VEC_4H, VEC_4I, TOKENS] = [
  19, 21, 22, 23, 25, 26, 27, 29, 30, 32,
];
const [REFERENCES, PAYLOAD, STRINGS, PAYLOADS] = [35, 47, 50, 55];

/** @import { CrateParser, MethodsOf } from "./three_private.js" */

/** @typedef {(parser: CrateParser) => any} Read a number or a truth value */
/** @typedef {new (length: number) => { [index: number]: number }} Kind */
/** @type {Read} */ const half = (parser) => parser._readHalf();
/** @type {Read} */ const double = ({ reader }) => reader.readFloat64();
/** @type {Read} */ const integer = ({ reader }) => reader.readInt32();
/** @type {Read} */ const byte = ({ reader }) => reader.readUint8();

/** Numbers per value, bytes per number, reader, array. @type {[number, [number, number, Read, Kind]][]} */
const KNOWN = [
  [BOOL, [1, 1, ({ reader }) => reader.readUint8() !== 0, Array]],
  [UCHAR, [1, 1, byte, Uint8Array]],
  [INT64, [1, 8, ({ reader }) => reader.readInt64(), Float64Array]],
  [UINT64, [1, 8, ({ reader }) => reader.readUint64(), Float64Array]],
  [MATRIX_3D, [9, 8, double, Float64Array]],
  [QUATD, [4, 8, double, Float64Array]],
  [QUATH, [4, 2, half, Float32Array]],
  [VEC_2D, [2, 8, double, Float64Array]],
  [VEC_2H, [2, 2, half, Float32Array]],
  [VEC_2I, [2, 4, integer, Int32Array]],
  [VEC_3D, [3, 8, double, Float64Array]],
  [VEC_3H, [3, 2, half, Float32Array]],
  [VEC_3I, [3, 4, integer, Int32Array]],
  [VEC_4D, [4, 8, double, Float64Array]],
  [VEC_4H, [4, 2, half, Float32Array]],
  [VEC_4I, [4, 4, integer, Int32Array]],
];
const TYPES = new Map(KNOWN);

/** @type {MethodsOf<CrateParser>} */ export const crateMethods = (kept) => ({
  // Whole numbers that fit are bytes in the place of the value's address.
  _readInlinedValue(rep) {
    const [numbers, bytes] = TYPES.get(rep.typeEnum) ?? [0, 0];
    const isOther = [MATRIX_3D, VEC_2H, QUATD, QUATH].includes(rep.typeEnum);
    if (numbers < 2 || bytes < 2 || isOther) return kept._readInlinedValue.call(this, rep);
    return Array.from({ length: numbers }, (_, i) => (rep.lo << (24 - 8 * i)) >> 24);
  },
  _readScalarValue(type) {
    if (type === TOKENS) return listed(this, ({ reader, tokens }) => tokens[reader.readUint32()] ?? "");
    if (type === REFERENCES) return [listed(this, (parser) => reference(parser, true)).join(", ")];
    if (type === PAYLOADS) return listed(this, (parser) => reference(parser, false)).join(", ");
    if (type === STRINGS)
      return Array.from({ length: countOf(this) }, () => this.tokens[this.strings[this.reader.readUint32()]] ?? "");
    if (type === PAYLOAD) return reference(this, false);
    const found = TYPES.get(type);
    if (!found || found[0] === 1) return kept._readScalarValue.call(this, type);
    return Array.from({ length: found[0] }, () => found[2](this));
  },
  _readArrayValue(rep) {
    const found = rep.isCompressed ? null : TYPES.get(rep.typeEnum);
    if (!found) return kept._readArrayValue.call(this, rep);
    const { reader, version } = this;
    const [numbers, bytes, read, Kind] = found;
    const size = version.major === 0 && version.minor < 7 ? reader.readUint32() : reader.readUint64();
    const count = numbers * size;
    if (!(count * bytes <= this.buffer.byteLength - reader.tell()))
      throw new Error(`an array of ${size} values does not fit into the file; it is damaged`);
    const values = new Kind(count);
    for (let i = 0; i < count; i++) values[i] = read(this);
    return values;
  },
});

/** A count of values of four bytes or more. @param {CrateParser} parser */
function countOf({ reader, buffer }) {
  const count = reader.readUint64();
  if (!(4 * count <= buffer.byteLength - reader.tell()))
    throw new Error(`a list of ${count} values does not fit into the file; it is damaged`);
  return count;
}

/** A list without deleted entries. @template T @param {CrateParser} parser @param {(parser: CrateParser) => T} read */
function listed(parser, read) {
  const { reader } = parser;
  const flags = reader.readUint8();
  /** @type {T[]} */ const found = [];
  for (const bit of [0x02, 0x04, 0x20, 0x40]) {
    if (!(flags & bit)) continue;
    for (let left = countOf(parser); left > 0; left--) found.push(read(parser));
  }
  return found;
}

/** A reference as text has it: "@file@<prim>". @param {CrateParser} parser @param {boolean} hasNotes */
function reference({ reader, tokens, strings, paths, version }, hasNotes) {
  const [file, prim] = [tokens[strings[reader.readUint32()]] ?? "", paths[reader.readUint32()] ?? ""];
  if (hasNotes || version.minor >= 8) reader.seek(reader.tell() + 16); // the offset of its time
  if (hasNotes && reader.readUint64())
    throw new Error(`${file}${prim}: a reference with custom data is not read here; voxrt build reads it`);
  return `${file ? `@${file}@` : ""}${prim ? `<${prim}>` : ""}`;
}
