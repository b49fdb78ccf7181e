// The picture on the canvas, of frames that come in bands.

import { average, Picture } from "./picture.js";
/** @import { Registers } from "./camera.js" @import { Frame } from "./protocol.js" */

/** @typedef {{ top: number, pixels: Uint8ClampedArray<ArrayBuffer> }} Band the first row, and RGBA */
/** @typedef {Frame & { bands: Band[], camera: Registers }} BandFrame */

export class BandPicture extends Picture {
  /** @param {BandFrame} frame @param {number} samples columns and rows of the frame per pixel */
  showBands({ width, height, bands }, samples) {
    const columns = width / samples;
    this.resize(columns, height / samples);
    for (const { top, pixels } of bands) {
      const rows = pixels.length / (4 * width * samples);
      const image = samples === 1 ? new ImageData(pixels, columns) : this.context.createImageData(columns, rows);
      if (samples > 1) average(pixels, 4, width, columns, rows, image.data);
      this.context.putImageData(image, 0, top / samples);
    }
  }
}

/** The colours of a frame, RGB, row by row. @param {BandFrame} frame */
export function coloursOf({ width, height, bands }) {
  const colours = new Uint8Array(3 * width * height);
  for (const { top, pixels } of bands)
    for (let from = 0, to = 3 * width * top; from < pixels.length; from += 4, to += 3) {
      colours[to] = pixels[from];
      colours[to + 1] = pixels[from + 1];
      colours[to + 2] = pixels[from + 2];
    }
  return colours;
}
