// Textures and vertex colours of glTF files: what voxrt build reads of them, by the file's own numbers.

import { colours } from "./voxrt/scene.js";
import { decodeImage } from "./images.js";

const WRAPS = { 10497: "repeat", 33648: "mirror", 33071: "clamp" };
const NEAREST = 9728;
const BLEND_CUTOFF = 0.5;
const GLOSSY = "KHR_materials_pbrSpecularGlossiness";
const UNREADABLE = { KHR_texture_basisu: "KTX2", MSFT_texture_dds: "DDS", EXT_texture_avif: "AVIF" };

export class GltfLooks {
  // The plugins of three.js' loader that would decode images; in their place come empty textures.
  static loaders = ["EXT_texture_webp", "EXT_texture_avif", "KHR_texture_basisu", "voxrt_textures"];

  constructor(folder) {
    this.folder = folder;
    this.warnings = new Map();
    this.textures = new Map(); // index -> texture of voxrt.js, or null
    this.entries = new Map();
  }

  async placeholder(parser, index, texture) {
    parser.associations.set(texture, { textures: index });
    return texture;
  }

  warn(kind, message, count = 1) {
    this.warnings.set(message, { kind, message, count: (this.warnings.get(message)?.count ?? 0) + count });
  }

  // Decode the images that materials in use need.
  async read(parser) {
    this.json = parser.json;
    this.parser = parser;
    const used = new Set(
      (this.json.meshes ?? []).flatMap(({ primitives }) => primitives.map(({ material }) => material)),
    );
    const images = new Map();
    for (const material of used) {
      const info = material === undefined ? null : this.properties(material).texture;
      if (!info || this.textures.has(info.index)) continue;
      this.textures.set(info.index, await this.texture(info.index, images));
    }
  }

  async texture(index, images) {
    const texture = this.json.textures[index];
    const source = texture.extensions?.EXT_texture_webp?.source ?? texture.source;
    const factor = "its materials took the colour of their factor";
    if (source === undefined) {
      const kind = Object.keys(UNREADABLE).find((name) => name in (texture.extensions ?? {}));
      this.warn(
        "texture",
        kind
          ? `textures[${index}] has only a ${UNREADABLE[kind]} image: ${factor}; convert its images to PNG or JPEG`
          : `textures[${index}] has no image: ${factor}`,
      );
      return null;
    }
    if (!images.has(source)) images.set(source, await this.image(source, factor));
    const image = images.get(source);
    const { wrapS = 10497, wrapT = 10497, magFilter } = this.json.samplers?.[texture.sampler] ?? {};
    return image && { image, wrap: [WRAPS[wrapS], WRAPS[wrapT]], nearest: magFilter === NEAREST };
  }

  async image(index, factor) {
    const { uri, bufferView } = this.json.images[index];
    let bytes = null;
    if (uri === undefined) bytes = await this.parser.getDependency("bufferView", bufferView);
    else if (uri.startsWith("data:")) bytes = await (await fetch(uri)).arrayBuffer();
    else {
      bytes = this.folder.find(uri)?.bytes;
      if (!bytes) {
        this.warn("texture", `images[${index}]: no image '${uri.slice(0, 60)}' in the asset's folder; ${factor}`);
        return null;
      }
    }
    return decodeImage(new Uint8Array(bytes), `images[${index}]`);
  }

  properties(index) {
    const material = this.json.materials[index];
    const base = material.pbrMetallicRoughness ?? {};
    const glossy = material.extensions?.[GLOSSY];
    const factor = (glossy ? glossy.diffuseFactor : base.baseColorFactor) ?? [1, 1, 1, 1];
    const extras = material.extras ?? {};
    return {
      name: extras.voxrt_material || material.name || `materials[${index}]`,
      factor: factor.map((part) => Math.min(Math.max(part, 0), 1)),
      texture: glossy ? glossy.diffuseTexture : base.baseColorTexture,
      cutoff: { MASK: material.alphaCutoff ?? 0.5, BLEND: BLEND_CUTOFF }[material.alphaMode] ?? 0,
      mirror: Boolean(extras.voxrt_reflect),
    };
  }

  isLeftOut(index) {
    if (index === undefined) return false;
    const { factor, cutoff } = this.properties(index);
    return factor[3] < cutoff;
  }

  // The look of a primitive; null where its colour is uniform. `index`: of its material, undefined for none.
  appearance(index, geometry) {
    const {
      name,
      factor,
      texture: info,
      cutoff,
      mirror,
    } = index === undefined
      ? { name: "default", factor: [1, 1, 1, 1], cutoff: 0, mirror: false }
      : this.properties(index);
    const colourOf = this.colours(geometry);
    let uvOf = info && this.textures.get(info.index) ? this.coordinates(info, geometry) : null;
    const texture = uvOf ? this.textures.get(info.index) : null;
    if (!texture && !colourOf) return null;
    const key = `${index} ${texture === null}`;
    if (!this.entries.has(key)) this.entries.set(key, { name, factor, texture, cutoff, mirror });
    return { entry: this.entries.get(key), uvOf, colourOf };
  }

  colours(geometry) {
    const attribute = geometry.getAttribute("color");
    if (!attribute) return null;
    const set = colours(attribute);
    const one = [0, 0, 0, 0];
    let [white, numbers] = [true, true];
    for (let i = 0; i < attribute.count; i++) {
      set(i, one);
      numbers &&= one.every(Number.isFinite);
      white &&= one.every((part) => part >= 1);
    }
    if (!numbers) this.warn("vertex-colour", "vertex colours that are not numbers were taken as black");
    if (white) return null;
    return (vertex, out) => {
      set(vertex, out);
      for (let channel = 0; channel < 4; channel++)
        out[channel] = Number.isFinite(out[channel]) ? Math.min(Math.max(out[channel], 0), 1) : 0;
    };
  }

  coordinates(info, geometry) {
    const moved = info.extensions?.KHR_texture_transform;
    const number = moved?.texCoord ?? info.texCoord ?? 0;
    const attribute = geometry.getAttribute(number === 0 ? "uv" : number < 4 ? `uv${number}` : `texcoord_${number}`);
    if (!attribute) {
      this.warn(
        "texture",
        `primitives without the TEXCOORD_${number} that their texture needs took the colour of their factor`,
      );
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
