// .mem files: octree words as text for $readmemh, one word per line. read_mem.js reads them.

import { FACES } from "./voxrt/voxrt.js";

// The bytes of a .mem file.
export function memBytes(words) {
  const digits = new TextEncoder().encode("0123456789ABCDEF");
  const bytes = new Uint8Array(9 * words.length);
  words.forEach((word, i) => {
    for (let digit = 0; digit < 8; digit++) bytes[9 * i + digit] = digits[(word >>> (28 - 4 * digit)) & 15];
    bytes[9 * i + 8] = 10;
  });
  return bytes;
}

// The lighting of a memory that says nothing else; the fields are those of manifests.
export const PLAIN = { position: [0, 0, 0], ambient: 90, on: false, flat: false, bounces: 0, faces: FACES };

// The lighting of a memory with baked light.
export const FLAT = { ...PLAIN, flat: true };
