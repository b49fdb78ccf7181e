// What materials of three.js look like: their colours, textures, and the colours of vertices.

/** @import { BufferAttribute, BufferGeometry, InterleavedBufferAttribute, Material, MeshBasicMaterial } from "three" */
/** @import { Texture } from "three" @import { Appearance, Image, Wrap } from "./scene_format.js" */
/** @import { Voxrt } from "./voxrt.js" @import { Warn } from "./warnings.js" */

/** @typedef {BufferAttribute | InterleavedBufferAttribute} Attribute */
/** @typedef {(vertex: number, out: { [index: number]: number }) => void} Setter sets numbers of a vertex */

/** What triangles show. The entry is the same object for the same look. `uvOf`: sets two numbers; `colourOf`: sets
 * four numbers: linear colour and alpha; `covers`: whether a vertex has a colour; a triangle of which none has is
 * plain. @typedef {{ entry: Appearance, uvOf?: Setter | null, colourOf?: Setter | null, covers?: (vertex: number)
 * => boolean }} Look */

/** @type {Record<number, Wrap>} */ const WRAPS = { 1000: "repeat", 1001: "clamp", 1002: "mirror" };
const NEAREST = 1003;

/** @param {Material} material */ const rgbOf = (material) => {
  const { r, g, b } = /** @type {MeshBasicMaterial} */ (material).color ?? { r: 1, g: 1, b: 1 };
  return [r, g, b];
};

/** The sRGB of a material's own colour. @param {Material} material @param {Voxrt} voxrt */
export const colourOf = (material, voxrt) => rgbOf(material).map((channel) => voxrt.srgb(channel));
/** @type {WeakMap<Material, { textured?: Appearance, coloured?: Appearance }>} */ const looks = new WeakMap();

/** The look of a material, apart from alpha; null where its colour is uniform. @param {Material} material @param
 * {BufferGeometry} geometry @param {Warn} warn @returns {Look | null} */
export function appearanceOfThree(material, geometry, warn) {
  const colour = material?.vertexColors ? geometry.getAttribute("color") : null;
  const uv = geometry.getAttribute("uv");
  const { map = null } = /** @type {Partial<MeshBasicMaterial>} */ (material ?? {});
  const image = map && uv ? pixelsOf(map, warn) : null;
  if (!colour && !image) return null;
  const known = looks.get(material) ?? {};
  looks.set(material, known);
  const kind = image ? "textured" : "coloured";
  known[kind] ??= {
    name: material.name || "material",
    factor: [...rgbOf(material), 1],
    texture: map && image && { image, wrap: wrapsOf(map), nearest: map.magFilter === NEAREST },
  };
  const uvOf = map && image ? coordinatesOf(uv, map) : null;
  return { entry: known[kind], uvOf, colourOf: colour ? colours(colour) : null };
}

/** @param {Texture} texture */
const wrapsOf = ({ wrapS, wrapT }) => [wrapS, wrapT].map((wrap) => WRAPS[wrap] ?? "repeat");

/** Sets u and v, moved as the texture says. @param {Attribute} uv @param {Texture} texture */
function coordinatesOf(uv, texture) {
  texture.updateMatrix();
  const [a, b, , c, d, , e, f] = texture.matrix.elements;
  /** @type {Setter} */ return (vertex, out) => {
    const [u, v] = [uv.getX(vertex), uv.getY(vertex)];
    out[0] = a * u + c * v + e;
    out[1] = b * u + d * v + f;
  };
}

/** Sets linear colour and alpha from an attribute. @param {Attribute} attribute @returns {Setter} */
export const colours = (attribute) => (vertex, out) => {
  out[0] = attribute.getX(vertex);
  out[1] = attribute.getY(vertex);
  out[2] = attribute.getZ(vertex);
  out[3] = attribute.itemSize === 4 ? attribute.getW(vertex) : 1;
};

/** @typedef {{ data?: Uint8Array, width: number, height: number }} Source the image of a texture */
/** @type {WeakMap<Source, Image | null>} */ const read = new WeakMap();

/** The pixels of a texture, row 0 at v = 0; null if unreadable. @param {Texture} texture @param {Warn} warn */
function pixelsOf(texture, warn) {
  const image = /** @type {Source | null} */ (texture.image);
  if (image && !read.has(image)) read.set(image, pixelsOfImage(image));
  const found = image ? read.get(image) : null;
  if (!found) warn("texture", "a texture cannot be read here; its material took its plain colour");
  return found && texture.flipY ? turned(found) : (found ?? null);
}

/** @param {Source} image @returns {Image | null} */ function pixelsOfImage(image) {
  const { data, width, height } = image;
  if (data?.length === 4 * width * height && data.BYTES_PER_ELEMENT === 1) return { width, height, pixels: data };
  if (typeof OffscreenCanvas === "undefined" || !(image instanceof ImageBitmap)) return null;
  const context = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
  if (!context) return null;
  context.drawImage(image, 0, 0);
  return { width, height, pixels: context.getImageData(0, 0, width, height).data };
}

/** @type {WeakMap<Image, Image>} */ const upside = new WeakMap();

/** The image with its rows in the opposite order. @param {Image} image */
function turned(image) {
  const known = upside.get(image);
  if (known) return known;
  const { width, height } = image;
  const pixels = new Uint8Array(image.pixels.length);
  for (let row = 0, to = 0; row < height; row++)
    for (let at = 4 * width * (height - 1 - row), end = at + 4 * width; at < end; at++) pixels[to++] = image.pixels[at];
  const made = { width, height, pixels };
  upside.set(image, made);
  return made;
}
