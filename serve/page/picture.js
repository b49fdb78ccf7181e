// The picture on the canvas. A frame with four rays per pixel is averaged in linear light.

import { fileName, save } from "./save.js";
/** @import { Size } from "./camera.js" */

const STEPS = 4096; // of linear light
const linear = Float32Array.from({ length: 256 }, (_, value) => {
  const part = value / 255;
  return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
});
const encoded = Uint8Array.from({ length: STEPS + 1 }, (_, step) => {
  const part = step / STEPS;
  return Math.round(255 * (part <= 0.0031308 ? 12.92 * part : 1.055 * part ** (1 / 2.4) - 0.055));
});

export class Picture {
  /** @type {ImageData | null} */ #image = null;

  /** @param {HTMLCanvasElement} canvas */ constructor(canvas) {
    this.canvas = canvas;
    this.context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d", { alpha: false }));
  }

  /** @param {number} columns @param {number} rows */ resize(columns, rows) {
    if (this.canvas.width === columns && this.canvas.height === rows) return;
    Object.assign(this.canvas, { width: columns, height: rows });
    this.#image = null;
  }

  /** Show a frame, RGB. @param {{ width: number, height: number, pixels: Uint8Array }} frame @param {number} samples
   * columns and rows of the frame per pixel @param {boolean} sharp whether large pixels keep their edges */
  show({ width, height, pixels }, samples, sharp) {
    const [columns, rows] = [width / samples, height / samples];
    this.resize(columns, rows);
    this.#image ??= this.context.createImageData(columns, rows);
    if (samples === 1) {
      const opaque = new Uint32Array(this.#image.data.buffer);
      for (let i = 0, at = 0; i < opaque.length; i++, at += 3)
        opaque[i] = 0xff000000 | (pixels[at + 2] << 16) | (pixels[at + 1] << 8) | pixels[at]; // every browser is little-endian
    } else average(pixels, 3, width, columns, rows, this.#image.data);
    this.context.putImageData(this.#image, 0, 0);
    this.canvas.classList.toggle("pixels", sharp && this.canvas.clientWidth > 1.9 * columns);
  }

  /** The column and row of the frame at a place of the page. @param {number} x @param {number} y */
  pixelAt(x, y) {
    const box = this.canvas.getBoundingClientRect();
    const { width, height } = this.canvas;
    const part = Math.min(box.width / width, box.height / height);
    const [right, down] = [x - box.left - box.width / 2, y - box.top - box.height / 2];
    return [Math.floor(right / part + width / 2), Math.floor(down / part + height / 2)];
  }

  /** @param {string} name */ save(name) {
    savePng(this.canvas, name);
  }
}

/** @param {HTMLCanvasElement} canvas @param {string} name */ export function savePng(canvas, name) {
  canvas.toBlob((blob) => {
    if (blob) save(blob, fileName(name, "png"));
  }, "image/png");
}

/** The mean of each 2 x 2 pixels, sRGB, as RGBA. @param {ArrayLike<number>} pixels @param {number} step bytes per
 * pixel @param {number} width @param {number} columns @param {number} rows @param {Uint8ClampedArray} result */
export function average(pixels, step, width, columns, rows, result) {
  const below = step * width;
  for (let row = 0, to = 0; row < rows; row++) {
    for (let column = 0, at = 2 * row * below; column < columns; column++, at += 2 * step) {
      for (let channel = 0; channel < 3; channel++) {
        const from = at + channel;
        const sum =
          linear[pixels[from]] +
          linear[pixels[from + step]] +
          linear[pixels[from + below]] +
          linear[pixels[from + below + step]];
        result[to++] = encoded[Math.round((sum * STEPS) / 4)];
      }
      result[to++] = 255;
    }
  }
}

/** The mean of pictures of one size, sRGB, RGBA. @param {ArrayLike<number>[]} pictures @param {Uint8ClampedArray} result */
export function mean(pictures, result) {
  for (let at = 0; at < result.length; at++) {
    let sum = 0;
    for (const pixels of pictures) sum += linear[pixels[at]];
    result[at] = at % 4 === 3 ? 255 : encoded[Math.round((sum * STEPS) / pictures.length)];
  }
}
