// The picture on the canvas, of frames that come in bands.

import { average, Picture } from "./picture.js";
/** @import { Registers, Size } from "./camera.js" @import { Frame } from "./protocol.js" */

/** @typedef {{ top: number, pixels: Uint8ClampedArray<ArrayBuffer> }} Band the first row, and RGBA */

/** `edition`: patches that the memory had when the frame was requested. @typedef {Frame & { bands: Band[], camera:
 * Registers, edition: number }} BandFrame */

export class BandPicture extends Picture {
  /** @param {BandFrame} frame @param {number} samples columns and rows of the frame per pixel */
  showBands(frame, samples) {
    this.resize(frame.width / samples, frame.height / samples);
    this.#put(frame, samples, [0, 0]);
  }

  /** Put a part, which was rendered by itself, into a frame and into its picture. @param {BandFrame} frame @param
   * {number} samples @param {BandFrame} part @param {Size} at column and row of the frame */
  showPart(frame, samples, part, at) {
    this.#put(part, samples, at);
    for (const { top, pixels } of part.bands)
      for (let from = 0, row = at[1] + top; from < pixels.length; from += 4 * part.width, row++) {
        const band = frame.bands.find((one) => row >= one.top && row < one.top + one.pixels.length / (4 * frame.width));
        band?.pixels.set(pixels.subarray(from, from + 4 * part.width), 4 * ((row - band.top) * frame.width + at[0]));
      }
  }

  /** @param {BandFrame} frame @param {number} samples @param {Size} at */ #put({ width, bands }, samples, at) {
    const columns = width / samples;
    for (const { top, pixels } of bands) {
      const rows = pixels.length / (4 * width * samples);
      const image = samples === 1 ? new ImageData(pixels, columns) : this.context.createImageData(columns, rows);
      if (samples > 1) average(pixels, 4, width, columns, rows, image.data);
      this.context.putImageData(image, at[0] / samples, (at[1] + top) / samples);
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
