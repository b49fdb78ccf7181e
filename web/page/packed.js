// A memory with its manifest as a short text, for links and for pages of one file: base64url of zlib's bytes, whose
// checksum tells whether all of it has arrived.
//
// Each word is one number of 1 to 5 bytes, seven bits per byte, the lowest first. A leaf of material m is 2m. A pointer
// is odd: the rest is how many blocks it is before (even) or behind (odd) the block after all that were named so far,
// so that most are 1. The manifest stands before the words; both begin with their length.

import { boundedBytes } from "./bounded.js";
import { memBytes } from "./memory.js";
import { isLeaf, leaf } from "./voxrt/words.js";
/** @import { DroppedFile } from "./folder.js" */

const BLOCK = 8; // words
const LONGEST = 5; // bytes of a number

/** @param {Uint8Array<ArrayBuffer>} bytes @param {CompressionStream | DecompressionStream} stream */
const through = (bytes, stream) => new Blob([bytes]).stream().pipeThrough(stream);

/** @param {Uint8Array} bytes */ function textOf(bytes) {
  let text = "";
  for (let at = 0; at < bytes.length; at += 1 << 14) text += String.fromCharCode(...bytes.subarray(at, at + (1 << 14)));
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/** @param {string} text */ const bytesOf = (text) =>
  Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (one) => one.charCodeAt(0));

/** @param {object} manifest @param {Uint32Array} words */ export async function pack(manifest, words) {
  const known = new TextEncoder().encode(JSON.stringify(manifest));
  const bytes = new Uint8Array(known.length + LONGEST * (words.length + 2));
  let at = 0;
  /** @param {number} number */ const put = (number) => {
    let rest = number;
    for (; rest > 127; rest = Math.floor(rest / 128)) bytes[at++] = 128 | (rest % 128);
    bytes[at++] = rest;
  };
  put(known.length);
  bytes.set(known, at);
  at += known.length;
  put(words.length);
  let next = 1; // the block after all that were named so far
  for (const word of words) {
    if (isLeaf(word)) {
      put(2 * ((word ^ leaf(0)) >>> 0));
      continue;
    }
    const before = (next - word) / BLOCK;
    put(2 * (before < 0 ? -2 * before - 1 : 2 * before) + 1);
    next = Math.max(next, word + BLOCK);
  }
  const short = through(bytes.subarray(0, at), new CompressionStream("deflate"));
  return textOf(new Uint8Array(await new Response(short).arrayBuffer()));
}

/** The files of a packed memory: it, and its manifest. A few bytes can unpack to many, so strangers' texts need a
 * limit. @param {string} text @param {number} [most] bytes that are unpacked @returns {Promise<DroppedFile[]>} */
export async function unpack(text, most = Infinity) {
  try {
    const bytes = await boundedBytes(through(bytesOf(text), new DecompressionStream("deflate")), most);
    if (bytes) return read(bytes);
  } catch {
    throw new Error("it is damaged or cut off; copy it again");
  }
  throw new Error(`it unpacks to more than ${most / 2 ** 20} MiB, more than links carry`);
}

/** @param {Uint8Array<ArrayBuffer>} bytes */ function read(bytes) {
  let at = 0;
  const take = () => {
    let number = 0;
    for (let factor = 1; ; factor *= 128) {
      if (at >= bytes.length) throw new RangeError("cut off");
      const byte = bytes[at++];
      number += (byte & 127) * factor;
      if (byte < 128) return number;
    }
  };
  const length = take();
  const known = bytes.slice(at, at + length);
  at += length;
  const words = new Uint32Array(Math.min(take(), bytes.length));
  let next = 1;
  for (let i = 0; i < words.length; i++) {
    const number = take();
    const [isPointer, rest] = [number % 2 === 1, Math.floor(number / 2)];
    words[i] = isPointer ? next - BLOCK * (rest % 2 ? -(rest + 1) / 2 : rest / 2) : leaf(0) ^ rest;
    if (isPointer) next = Math.max(next, words[i] + BLOCK);
  }
  const { name } = JSON.parse(new TextDecoder().decode(known));
  return [
    { name: `${name}.mem`, bytes: memBytes(words) },
    { name: `${name}.json`, bytes: known },
  ];
}
