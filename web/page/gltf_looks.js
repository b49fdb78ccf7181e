// Textures and vertex colours of glTF files: what voxrt build reads of them, by the file's own numbers.

import { decodeImage } from "./images.js";
import { leftOut, OPAQUE_FROM } from "./voxrt/opacity.js";
import { colours } from "./voxrt/scene.js";
import { Warnings } from "./voxrt/warnings.js";
/** @import { BufferGeometry, Material, Object3D, Texture } from "three" */
/** @import { GLTFParser } from "three/addons/loaders/GLTFLoader.js" @import { Folder } from "./folder.js" */
/** @import { Look, Setter } from "./voxrt/scene.js" @import { Appearance, Image, Wrap } from "./voxrt/voxrt.js" */

/** @typedef {{ index: number, texCoord?: number, extensions?: { KHR_texture_transform?: Moved } }} TextureInfo */
/** @typedef {{ texCoord?: number, offset?: number[], scale?: number[], rotation?: number }} Moved */

/** @typedef {any} Gltf the file's own JSON */
/** @typedef {{ nodes?: number, materials?: number, textures?: number }} Association */

/** What is used of GLTFLoader's parser. @typedef {{ json: Gltf, associations: Map<Material | Object3D | Texture,
 * Association>, getDependency: (type: "bufferView", index: number) => Promise<ArrayBuffer> }} GltfParser */

/** @type {Record<number, Wrap>} */ const WRAPS = { 10497: "repeat", 33648: "mirror", 33071: "clamp" };
const NEAREST = 9728;
const GLOSSY = "KHR_materials_pbrSpecularGlossiness";
/** @type {Record<string, string>} */
const UNREADABLE = { KHR_texture_basisu: "KTX2", MSFT_texture_dds: "DDS", EXT_texture_avif: "AVIF" };

export class GltfLooks {
  /** The plugins of three.js' loader that would decode images; in their place come empty textures. */
  static loaders = ["EXT_texture_webp", "EXT_texture_avif", "KHR_texture_basisu", "voxrt_textures"];

  warnings = new Warnings();
  /** @type {Map<number, Appearance["texture"] | null>} by index */ #textures = new Map();
  /** @type {Map<string, Appearance>} */ #entries = new Map();
  /** @type {Gltf} */ #json = { materials: [], textures: [], images: [] };

  /** @param {Folder} folder */ constructor(folder) {
    this.folder = folder;
  }

  /** @param {GLTFParser} parser @param {number} index @param {Texture} texture */
  async placeholder(parser, index, texture) {
    parser.associations.set(texture, { textures: index });
    return texture;
  }

  /** Decode the images that materials in use need. @param {GltfParser} parser */
  async read(parser) {
    this.#json = parser.json;
    /** @type {Gltf[]} */ const primitives = (this.#json.meshes ?? []).flatMap(
      (/** @type {Gltf} */ mesh) => mesh.primitives,
    );
    /** @type {Set<number | undefined>} */ const used = new Set(primitives.map(({ material }) => material));
    /** @type {Map<number, Image | null>} */ const images = new Map();
    for (const material of used) {
      const info = material === undefined ? null : this.properties(material).texture;
      if (!info || this.#textures.has(info.index)) continue;
      this.#textures.set(info.index, await this.#texture(parser, info.index, images));
    }
  }

  /** @param {GltfParser} parser @param {number} index @param {Map<number, Image | null>} images */
  async #texture(parser, index, images) {
    const texture = this.#json.textures[index];
    const source = texture.extensions?.EXT_texture_webp?.source ?? texture.source;
    const factor = "its materials took the colour of their factor";
    if (source === undefined) {
      const kind = Object.keys(UNREADABLE).find((name) => name in (texture.extensions ?? {}));
      const advice = kind ? "; convert its images to PNG or JPEG" : "";
      const image = kind ? `only a ${UNREADABLE[kind]} image` : "no image";
      this.warnings.warn("texture", `textures[${index}] has ${image}: ${factor}${advice}`);
      return null;
    }
    if (!images.has(source)) images.set(source, await this.#image(parser, source, factor));
    const image = images.get(source);
    const { wrapS = 10497, wrapT = 10497, magFilter } = this.#json.samplers?.[texture.sampler ?? -1] ?? {};
    const wrap = [wrapS, wrapT].map((code) => WRAPS[code] ?? "repeat");
    return image ? { image, wrap, nearest: magFilter === NEAREST } : null;
  }

  /** @param {GltfParser} parser @param {number} index @param {string} factor what is shown instead */
  async #image(parser, index, factor) {
    const { uri, bufferView } = this.#json.images[index];
    /** @type {ArrayBuffer | Uint8Array | undefined} */ let bytes;
    if (uri === undefined) bytes = await parser.getDependency("bufferView", bufferView);
    else if (uri.startsWith("data:")) bytes = await (await fetch(uri)).arrayBuffer();
    else {
      bytes = this.folder.find(uri)?.bytes;
      const absent = `images[${index}]: no image '${uri.slice(0, 60)}' in the asset's folder; ${factor}`;
      if (!bytes) {
        this.warnings.warn("texture", absent);
        return null;
      }
    }
    return decodeImage(new Uint8Array(bytes), `images[${index}]`);
  }

  /** @param {number} index of a material */ properties(index) {
    const material = this.#json.materials[index];
    const base = material.pbrMetallicRoughness ?? {};
    const glossy = material.extensions?.[GLOSSY];
    /** @type {number[]} */ let factor = (glossy ? glossy.diffuseFactor : base.baseColorFactor) ?? [1, 1, 1, 1];
    let texture = glossy ? glossy.diffuseTexture : base.baseColorTexture;
    const strength = material.extensions?.KHR_materials_emissive_strength?.emissiveStrength ?? 1;
    /** @type {number[]} */ const glow = material.emissiveFactor ?? [0, 0, 0];
    const emission = glow.map((part) => part * strength);
    const emits = Math.max(...factor.slice(0, 3)) <= 0 && Math.max(...emission) > 0;
    if (emits) {
      factor = [...emission, factor[3]]; // it reflects nothing, and shows what it emits
      texture = material.emissiveTexture;
    }
    const extras = material.extras ?? {};
    /** @type {Record<string, number>} */ const cutoffs = {
      MASK: material.alphaCutoff ?? 0.5,
      BLEND: OPAQUE_FROM,
      OPAQUE: 0,
    };
    return {
      name: extras.voxrt_material || material.name || `materials[${index}]`,
      factor: factor.map((part) => Math.min(Math.max(part, 0), 1)),
      texture,
      cutoff: cutoffs[material.alphaMode ?? "OPAQUE"] ?? 0,
      mirror: Boolean(extras.voxrt_reflect),
      emits,
      isNamed: Boolean(extras.voxrt_material),
    };
  }

  /** @param {number | undefined} index of a material */ leavesOut(index) {
    if (index === undefined) return null;
    const { factor, cutoff } = this.properties(index);
    return leftOut(factor[3], cutoff);
  }

  /** The look of a primitive; null where its colour is uniform. @param {number | undefined} index @param
   * {BufferGeometry} geometry */
  appearance(index, geometry) {
    const plain = { name: "default", factor: [1, 1, 1, 1], texture: undefined, cutoff: 0, mirror: false, emits: false };
    const { name, factor, texture: info, cutoff, mirror, emits } = index === undefined ? plain : this.properties(index);
    const colourOf = this.#colours(geometry, emits);
    const uvOf = info && this.#textures.get(info.index) ? this.#coordinates(info, geometry) : null;
    const texture = (uvOf && info && this.#textures.get(info.index)) ?? null;
    if (!texture && !colourOf) return null;
    const key = `${index} ${texture === null}`;
    const entry = this.#entries.get(key) ?? { name, factor, texture, cutoff, mirror };
    this.#entries.set(key, entry);
    return { entry, uvOf, colourOf };
  }

  /** Only their alpha counts for what emits. @param {BufferGeometry} geometry @param {boolean} emits @returns {Setter |
   * null} */
  #colours(geometry, emits) {
    const attribute = geometry.getAttribute("color");
    if (!attribute) return null;
    const read = colours(attribute);
    /** @type {Setter} */ const set = (vertex, out) => {
      read(vertex, out);
      if (emits) Object.assign(out, [1, 1, 1]);
    };
    const one = [0, 0, 0, 0];
    let [white, numbers] = [true, true];
    for (let i = 0; i < attribute.count; i++) {
      set(i, one);
      numbers &&= one.every(Number.isFinite);
      white &&= one.every((part) => part >= 1);
    }
    if (!numbers) this.warnings.warn("vertex-colour", "vertex colours that are not numbers were taken as black");
    if (white) return null;
    return (vertex, out) => {
      set(vertex, out);
      for (let channel = 0; channel < 4; channel++)
        out[channel] = Number.isFinite(out[channel]) ? Math.min(Math.max(out[channel], 0), 1) : 0;
    };
  }

  /** @param {TextureInfo} info @param {BufferGeometry} geometry @returns {Setter | null} */
  #coordinates(info, geometry) {
    const moved = info.extensions?.KHR_texture_transform;
    const number = moved?.texCoord ?? info.texCoord ?? 0;
    const attribute = geometry.getAttribute(number === 0 ? "uv" : number < 4 ? `uv${number}` : `texcoord_${number}`);
    if (!attribute) {
      const name = `TEXCOORD_${number}`;
      const problem = `primitives without the ${name} that their texture needs took the colour of their factor`;
      this.warnings.warn("texture", problem);
      return null;
    }
    if (!moved)
      return (vertex, out) => {
        out[0] = attribute.getX(vertex);
        out[1] = attribute.getY(vertex);
      };
    const { offset = [0, 0], scale = [1, 1], rotation = 0 } = moved;
    const [cos, sin] = [Math.cos(rotation), Math.sin(rotation)];
    return (vertex, out) => {
      const [u, v] = [attribute.getX(vertex) * scale[0], attribute.getY(vertex) * scale[1]];
      out[0] = cos * u + sin * v + offset[0];
      out[1] = cos * v - sin * u + offset[1];
    };
  }
}
