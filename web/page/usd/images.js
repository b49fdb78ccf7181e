// The textures of a USD stage: images graded by their colour space, scale and bias, with the alpha of opacity textures.

import { decodeImage } from "../images.js";

export class UsdImages {
  constructor(folder, voxrt) {
    this.folder = folder;
    this.voxrt = voxrt;
    this.bytes = new Map(); // file -> bytes of a package
    this.images = new Map(); // file -> image, or null
    this.textures = new Map();
  }

  // Note the file of a source, as its layer names it.
  add(composer, source) {
    const path = composer._resolveFilePath(source.file);
    const held = composer.assets[path] ?? composer.assets[source.file];
    source.file = path;
    if (held instanceof Uint8Array) this.bytes.set(path, held);
    this.images.set(path, null);
  }

  // Decode all of them; those that cannot be decoded are missing.
  async read() {
    for (const file of this.images.keys()) {
      const found = this.bytes.has(file) ? { name: file, bytes: this.bytes.get(file) } : file && this.folder.find(file);
      if (found) this.images.set(file, await decodeImage(found.bytes, found.name).catch(() => null));
    }
  }

  // The texture of a shading; null where its image is missing.
  texture(shading) {
    if (!this.textures.has(shading)) this.textures.set(shading, this.combined(shading));
    return this.textures.get(shading);
  }

  combined({ image, alpha }) {
    const [colour, opacity] = [image, alpha].map((source) => source && this.images.get(source.file));
    if (image ? !colour : !opacity) return null;
    const { width, height } = colour ?? opacity;
    const pixels = colour ? this.graded(colour.pixels, image) : new Uint8Array(4 * width * height).fill(255);
    const fits = opacity && opacity.width === width && opacity.height === height;
    const channel = fits ? Math.max("rgba".indexOf(alpha.channel), 0) : 0;
    for (let at = 0; at < pixels.length; at += 4) pixels[at + 3] = fits ? opacity.pixels[at + channel] : 255;
    return { image: { width, height, pixels }, wrap: (image ?? alpha).wrap, nearest: false };
  }

  graded(pixels, { raw, factor, bias }) {
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

// Sets u and v from coordinates: scale, rotation, offset; v from the top, as rows of images go.
export function coordinates({ turn, scale, offset }) {
  const angle = (turn * Math.PI) / 180;
  const [cosine, sine] = [Math.cos(angle), Math.sin(angle)];
  return (u, v, out, at) => {
    const [a, b] = [u * scale[0], v * scale[1]];
    out[at] = a * cosine - b * sine + offset[0];
    out[at + 1] = 1 - (a * sine + b * cosine + offset[1]);
  };
}
