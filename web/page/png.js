// PNG images, decoded exactly: browsers multiply colours by alpha when pixels are read back. Sources: PNG, third edition
// (W3C), and the inflate that browsers and Node have.

const SIGNATURE = [137, 80, 78, 71, 13, 10, 26, 10];
/** @import { Pixels } from "./images.js" */

/** @typedef {{ width: number, height: number, depth: number, type: number, interlaced: boolean }} Head */
/** @typedef {(line: Uint8Array, i: number) => number} Read a value of a line */
/** @typedef {(line: Uint8Array, column: number, out: Uint8Array, at: number) => void} Write a pixel of a line */
/** @type {Record<number, number>} by the type of the image */ const CHANNELS = { 0: 1, 2: 3, 3: 1, 4: 2, 6: 4 };
// biome-ignore format: x, y, steps
const PASSES = [[0, 0, 8, 8], [4, 0, 8, 8], [0, 4, 4, 8], [2, 0, 4, 4], [0, 2, 2, 4], [1, 0, 2, 2], [0, 1, 1, 2]];
export const MOST_PIXELS = 1 << 26;
/** @param {Uint8Array} bytes */ export const isPng = (bytes) => SIGNATURE.every((byte, i) => bytes[i] === byte);

/** Pixels have 4 bytes, of 16 bits the upper 8. Throws an Error if broken. @param {Uint8Array<ArrayBuffer>} bytes */
export async function decodePng(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  /** @param {number} at */ const wordAt = (at) => view.getUint32(at);
  const parts = [];
  /** @type {Head | null} */ let head = null;
  /** @type {Uint8Array | null} */ let palette = null;
  /** @type {Uint8Array | null} */ let clear = null;
  for (let at = 8; at + 12 <= bytes.length; ) {
    const length = wordAt(at);
    const kind = String.fromCharCode(...bytes.subarray(at + 4, at + 8));
    const data = bytes.subarray(at + 8, at + 8 + length);
    if (data.length < length) throw new Error("the image is cut off");
    const [depth, type, interlaced] = [data[8], data[9], data[12] === 1];
    if (kind === "IHDR") head = { width: wordAt(at + 8), height: wordAt(at + 12), depth, type, interlaced };
    if (kind === "PLTE") palette = data;
    if (kind === "tRNS") clear = data;
    if (kind === "IDAT") parts.push(data);
    if (kind === "IEND") break;
    at += 12 + length;
  }
  if (!head || !(head.type in CHANNELS) || ![1, 2, 4, 8, 16].includes(head.depth) || !head.width || !head.height)
    throw new Error("the image is broken");
  if (head.type === 3 && !palette) throw new Error("the image has no palette");
  if (head.width * head.height > MOST_PIXELS)
    throw new Error(`the image has more than ${MOST_PIXELS.toLocaleString("en")} pixels`);
  const { width, height } = head;
  const bits = CHANNELS[head.type] * head.depth;
  const passes = (head.interlaced ? PASSES : [[0, 0, 1, 1]])
    .map(([x, y, across, down]) => {
      const [columns, rows] = [Math.ceil((width - x) / across), Math.ceil((height - y) / down)];
      return { x, y, across, down, columns, rows };
    })
    .filter(({ columns, rows }) => columns > 0 && rows > 0);
  const size = passes.reduce((sum, { columns, rows }) => sum + rows * (1 + Math.ceil((columns * bits) / 8)), 0);
  const data = await inflated(parts, size);
  const pixels = new Uint8Array(4 * width * height);
  const colour = colouring(head, palette, clear);
  let at = 0;
  for (const { x, y, across, down, columns, rows } of passes) {
    const length = Math.ceil((columns * bits) / 8);
    let above = new Uint8Array(length);
    for (let row = 0; row < rows; row++) {
      const line = data.subarray(at + 1, at + 1 + length);
      unfilter(data[at], line, above, Math.max(1, bits >> 3));
      for (let column = 0; column < columns; column++)
        colour(line, column, pixels, 4 * ((y + row * down) * width + x + column * across));
      above = line;
      at += 1 + length;
    }
  }
  return { width, height, pixels };
}

/** @param {Uint8Array<ArrayBuffer>[]} parts @param {number} size */ async function inflated(parts, size) {
  const out = new Uint8Array(size);
  const reader = new Blob(parts).stream().pipeThrough(new DecompressionStream("deflate")).getReader();
  let at = 0;
  try {
    while (at < size) {
      const { value, done } = await reader.read();
      if (done) break;
      out.set(value.subarray(0, size - at), at);
      at += value.length;
    }
  } catch {
    /* what was cut off is told below */
  }
  reader.cancel().catch(() => {});
  if (at < size) throw new Error("the image is cut off");
  return out;
}

/** @param {number} filter @param {Uint8Array} line @param {Uint8Array} above @param {number} step */
function unfilter(filter, line, above, step) {
  if (filter > 4) throw new Error("the image is broken");
  for (let i = 0; i < line.length; i++) {
    const left = i >= step ? line[i - step] : 0;
    const up = above[i];
    if (filter === 1) line[i] += left;
    else if (filter === 2) line[i] += up;
    else if (filter === 3) line[i] += (left + up) >> 1;
    else if (filter === 4) {
      const corner = i >= step ? above[i - step] : 0;
      const [toLeft, toUp] = [Math.abs(up - corner), Math.abs(left - corner)];
      const toCorner = Math.abs(left + up - 2 * corner);
      line[i] += toLeft <= toUp && toLeft <= toCorner ? left : toUp <= toCorner ? up : corner;
    }
  }
}

/** @param {number} depth bits per value @returns {Read} */ function reading(depth) {
  if (depth === 8) return (line, i) => line[i];
  if (depth === 16) return (line, i) => line[2 * i];
  return (line, i) => (line[(i * depth) >> 3] >> (8 - depth - ((i * depth) & 7))) & ((1 << depth) - 1);
}

/** @param {Head} head @param {Uint8Array | null} palette @param {Uint8Array | null} clear @returns {Write} */
function colouring({ type, depth }, palette, clear) {
  const value = reading(depth);
  /** @type {Read} */ const exact = depth === 16 ? (line, i) => 256 * line[2 * i] + line[2 * i + 1] : value;
  /** @param {number} channel */ const key = (channel) =>
    clear && clear.length > 2 * channel + 1 ? 256 * clear[2 * channel] + clear[2 * channel + 1] : -1;
  const scale = depth < 8 ? 255 / ((1 << depth) - 1) : 1;
  if (type === 3)
    return (line, column, out, at) => {
      const entry = value(line, column);
      for (let channel = 0; channel < 3; channel++) out[at + channel] = palette?.[3 * entry + channel] ?? 0;
      out[at + 3] = clear?.[entry] ?? 255;
    };
  if (type === 4)
    return (line, column, out, at) => {
      out.fill(value(line, 2 * column) * scale, at, at + 3);
      out[at + 3] = value(line, 2 * column + 1);
    };
  if (type === 0)
    return (line, column, out, at) => {
      out.fill(value(line, column) * scale, at, at + 3);
      out[at + 3] = depth < 16 && exact(line, column) === key(0) ? 0 : 255;
    };
  const channels = type === 6 ? 4 : 3;
  return (line, column, out, at) => {
    for (let channel = 0; channel < channels; channel++) out[at + channel] = value(line, channels * column + channel);
    if (type !== 2) return;
    const isClear = clear && [0, 1, 2].every((channel) => exact(line, 3 * column + channel) === key(channel));
    out[at + 3] = isClear ? 0 : 255;
  };
}
