// The picture on the canvas, of frames that come in bands: {top, pixels}, RGBA.

import { Picture, average } from "./picture.js";

export class BandPicture extends Picture {
  show({ width, height, bands }, samples) {
    const [columns, rows] = [width / samples, height / samples];
    if (this.canvas.width !== columns || this.canvas.height !== rows)
      Object.assign(this.canvas, { width: columns, height: rows });
    for (const { top, pixels } of bands) {
      const image =
        samples === 1
          ? new ImageData(pixels, columns)
          : this.context.createImageData(columns, pixels.length / (4 * width * samples));
      if (samples > 1) average(pixels, 4, width, columns, image.height, image.data);
      this.context.putImageData(image, 0, top / samples);
    }
  }
}

// The colours of a frame, RGB, row by row.
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
