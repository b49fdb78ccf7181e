// The textures of a USD stage: images graded by their colour space, scale and bias, with the alpha of opacity textures.

import { decodeImage } from "../images.js";
/** @import { Folder } from "../folder.js" @import { Pixels } from "../images.js" */
/** @import { Appearance, Voxrt } from "../voxrt/voxrt.js" */
/** @import { Coordinates, Shading, Texture } from "./shading.js" @import { Composer } from "./three_private.js" */

export class UsdImages {
  /** @type {Map<string, Uint8Array<ArrayBuffer>>} files of a package */ #bytes = new Map();
  /** @type {Map<string, Pixels | null>} by file */ #images = new Map();
  /** @type {Map<Shading, Appearance["texture"]>} */ #textures = new Map();

  /** @param {Folder} folder @param {Voxrt} voxrt */ constructor(folder, voxrt) {
    this.folder = folder;
    this.voxrt = voxrt;
  }

  /** Note the file of a texture, as its layer names it. @param {Composer} composer @param {Texture} source */
  add(composer, source) {
    const path = composer._resolveFilePath(source.file);
    const held = composer.assets[path] ?? composer.assets[source.file];
    source.file = path;
    if (held instanceof Uint8Array) this.#bytes.set(path, held);
    this.#images.set(path, null);
  }

  /** Decode all of them; those that cannot be decoded are missing. */
  async read() {
    for (const file of this.#images.keys()) {
      const packed = this.#bytes.get(file);
      const found = packed ? { name: file, bytes: packed } : this.folder.find(file);
      if (file && found) this.#images.set(file, await decodeImage(found.bytes, found.name).catch(() => null));
    }
  }

  /** The texture of a shading; null where its image is missing. @param {Shading} shading */
  texture(shading) {
    const texture = this.#textures.get(shading) ?? this.#combined(shading);
    this.#textures.set(shading, texture);
    return texture;
  }

  /** @param {Shading} shading */ #combined({ image, alpha }) {
    const colour = image && this.#images.get(image.file);
    const opacity = alpha && this.#images.get(alpha.file);
    const shape = image ? colour : opacity;
    const placed = image ?? alpha;
    if (!shape || !placed) return null;
    const { width, height } = shape;
    const pixels = colour && image ? this.#graded(colour.pixels, image) : new Uint8Array(4 * width * height).fill(255);
    const fits = opacity && opacity.width === width && opacity.height === height;
    const channel = fits ? Math.max("rgba".indexOf(alpha?.channel ?? "r"), 0) : 0;
    for (let at = 0; at < pixels.length; at += 4) pixels[at + 3] = fits ? opacity.pixels[at + channel] : 255;
    return { image: { width, height, pixels }, wrap: placed.wrap, nearest: false };
  }

  /** @param {Uint8Array} pixels @param {Texture} texture */ #graded(pixels, { raw, factor, bias }) {
    const made = Uint8Array.from(pixels);
    const plain = factor.slice(0, 3).every((part) => part === 1) && bias.slice(0, 3).every((part) => part === 0);
    if (plain && !raw) return made;
    const curves = [0, 1, 2].map((channel) =>
      Uint8Array.from({ length: 256 }, (_, code) =>
        this.voxrt.srgb((raw ? code / 255 : this.voxrt.linear(code)) * factor[channel] + bias[channel]),
      ),
    );
    for (let at = 0; at < made.length; at += 4)
      for (let channel = 0; channel < 3; channel++) made[at + channel] = curves[channel][made[at + channel]];
    return made;
  }
}

/** Sets u and v: scale, rotation, offset; v from the top. @param {Coordinates} moved */
export function coordinates({ turn, scale, offset }) {
  const angle = (turn * Math.PI) / 180;
  const [cosine, sine] = [Math.cos(angle), Math.sin(angle)];
  /** @param {number} u @param {number} v @param {{ [at: number]: number }} out @param {number} at */
  return (u, v, out, at) => {
    const [a, b] = [u * scale[0], v * scale[1]];
    out[at] = a * cosine - b * sine + offset[0];
    out[at + 1] = 1 - (a * sine + b * cosine + offset[1]);
  };
}
