// Pixels as canvases take them.

const ALPHA = 0xff000000;

/** RGB as opaque RGBA. Four pixels are three words of one and four of the other: WebAssembly and every browser are
 * little-endian. Rows of tiles start at a multiple of four bytes. @param {Uint8Array} rgb @param {Uint32Array} rgba */
export function opaque(rgb, rgba) {
  const fours = rgba.length >> 2;
  const words = new Uint32Array(rgb.buffer, rgb.byteOffset, 3 * fours);
  for (let i = 0, from = 0, to = 0; i < fours; i++, from += 3, to += 4) {
    const [a, b, c] = [words[from], words[from + 1], words[from + 2]];
    rgba[to] = a | ALPHA;
    rgba[to + 1] = (a >>> 24) | ((b & 0xffff) << 8) | ALPHA;
    rgba[to + 2] = (b >>> 16) | ((c & 0xff) << 16) | ALPHA;
    rgba[to + 3] = (c >>> 8) | ALPHA;
  }
  for (let to = 4 * fours; to < rgba.length; to++)
    rgba[to] = rgb[3 * to] | (rgb[3 * to + 1] << 8) | (rgb[3 * to + 2] << 16) | ALPHA;
}
