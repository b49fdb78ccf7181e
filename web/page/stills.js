// Pictures aside from those on the screen: a still of twice the page's pixels, and the frames of a film.

import { toRegisters } from "./camera.js";
import { $, element } from "./elements.js";
import { mean, savePng } from "./picture.js";
import { scale } from "./vectors.js";
/** @import { App } from "./app.js" @import { BandFrame } from "./band_picture.js" @import { Pose, Size } from "./camera.js" */
/** @import { Painter } from "./painter.js" */

const SHARPER = 2; // pixels of a saved picture per pixel of the page, in columns and in rows
const WIDEST = 4096; // pixels
/** Four places in a pixel, no two in one row or column of a grid of 4 x 4. */
const PLACES = [
  [-0.125, -0.375],
  [0.375, -0.125],
  [0.125, 0.375],
  [-0.375, 0.125],
];

/** A picture with four rays per pixel. Registers are coarse where pixels are many, so it is the mean of four frames, of
 * rays a part of a pixel apart. @param {Painter} painter @param {Pose} view @param {Size} size */
export async function still(painter, view, size) {
  const { position, look, right, up } = toRegisters(view, size);
  const frames = PLACES.map(([column, row]) => {
    const moved = look.map((part, axis) => Math.round(part + column * right[axis] - row * up[axis]));
    return painter.picture({ camera: { position, look: moved, right, up }, size });
  });
  const image = new ImageData(size[0], size[1]);
  mean((await Promise.all(frames)).map(pixelsOf), image.data);
  return image;
}

/** @param {App} app */ export async function savePicture(app) {
  const [memory, view] = [app.memory(), app.view()];
  if (!memory || !view) return;
  const { clientWidth, clientHeight } = $("stage");
  const part = Math.min(SHARPER, WIDEST / Math.max(clientWidth, clientHeight));
  const size = scale([clientWidth, clientHeight], part).map(Math.round);
  const image = await still(app.painter, view, size);
  const canvas = element("canvas", { width: size[0], height: size[1] });
  canvas.getContext("2d", { alpha: false })?.putImageData(image, 0, 0);
  savePng(canvas, memory.name);
}

/** @param {BandFrame} frame */ function pixelsOf({ width, height, bands }) {
  const pixels = new Uint8ClampedArray(4 * width * height);
  for (const band of bands) pixels.set(band.pixels, 4 * width * band.top);
  return pixels;
}
