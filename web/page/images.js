// Images of dropped files as {width, height, pixels}: 4 bytes per pixel, sRGB and alpha, row 0 at the top. PNG is decoded
// here; other kinds by the browser, without colour profiles and orientation, as voxrt build does.

import { decodePng, isPng, MOST_PIXELS } from "./png.js";

/** @typedef {{ width: number, height: number, pixels: Uint8Array<ArrayBuffer> }} Pixels */

/** @param {Uint8Array<ArrayBuffer>} bytes @param {string} place */ export async function decodeImage(bytes, place) {
  try {
    return isPng(bytes) ? await decodePng(bytes) : await byBrowser(bytes);
  } catch (error) {
    throw new Error(
      `${place}: the image cannot be decoded (${/** @type {Error} */ (error).message}); save the image again as PNG or JPEG`,
    );
  }
}

/** @param {Uint8Array<ArrayBuffer>} bytes */ async function byBrowser(bytes) {
  if (typeof createImageBitmap === "undefined") throw new Error("only browsers decode this kind");
  const plain = /** @type {const} */ ({ colorSpaceConversion: "none", premultiplyAlpha: "none" });
  const bitmap = await createImageBitmap(new Blob([bareJpeg(bytes)]), plain);
  const { width, height } = bitmap;
  if (width * height > MOST_PIXELS) throw new Error(`it has more than ${MOST_PIXELS.toLocaleString("en")} pixels`);
  const context = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
  if (!context) throw new Error("this browser has no canvas");
  context.drawImage(bitmap, 0, 0);
  bitmap.close();
  return { width, height, pixels: new Uint8Array(context.getImageData(0, 0, width, height).data.buffer) };
}

/** A JPEG file without colour profile and orientation (APP1, APP2). @param {Uint8Array<ArrayBuffer>} bytes */
function bareJpeg(bytes) {
  if (bytes[0] !== 0xff || bytes[1] !== 0xd8) return bytes;
  const kept = [bytes.subarray(0, 2)];
  let at = 2;
  while (at + 4 <= bytes.length && bytes[at] === 0xff && bytes[at + 1] !== 0xda) {
    const end = at + 2 + 256 * bytes[at + 2] + bytes[at + 3];
    if (bytes[at + 1] !== 0xe1 && bytes[at + 1] !== 0xe2) kept.push(bytes.subarray(at, end));
    at = end;
  }
  kept.push(bytes.subarray(at));
  const whole = new Uint8Array(kept.reduce((sum, part) => sum + part.length, 0));
  let end = 0;
  for (const part of kept) {
    whole.set(part, end);
    end += part.length;
  }
  return whole;
}
