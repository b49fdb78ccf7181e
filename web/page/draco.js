// Meshes that are compressed by Draco, for GLTFLoader: Google's decoder, loaded when a file needs it.

import { BufferAttribute, BufferGeometry } from "./three/three.core.js";
/** @import { DRACOLoader } from "three/addons/loaders/DRACOLoader.js" */

/** @typedef {Float32Array | Int8Array | Uint8Array | Int16Array | Uint16Array | Uint32Array} Values */
/** @typedef {{ BYTES_PER_ELEMENT: number, new (buffer: ArrayBufferLike, at: number, length: number): Values }} Kind */
/** @typedef {any} Draco Google's decoder, which has no types */

const FOLDER = "./three/draco/";
/** @type {Record<string, [Kind, string]>} */ const TYPES = {
  Float32Array: [Float32Array, "DT_FLOAT32"],
  Int8Array: [Int8Array, "DT_INT8"],
  Uint8Array: [Uint8Array, "DT_UINT8"],
  Int16Array: [Int16Array, "DT_INT16"],
  Uint16Array: [Uint16Array, "DT_UINT16"],
  Uint32Array: [Uint32Array, "DT_UINT32"],
};

/** What GLTFLoader needs of a decoder. */
export class DracoDecoder {
  /** @type {Promise<Draco> | null} */ #library = null;

  preload() {}

  /** @param {ArrayBuffer} buffer @param {(geometry: BufferGeometry) => void} use @param {Record<string, number>} ids
   * of attributes by name @param {Record<string, string>} types the names of their arrays @param {string} _space
   * @param {(error: Error) => void} refuse */
  decodeDracoFile(buffer, use, ids, types, _space, refuse) {
    this.#library ??= load();
    this.#library.then((draco) => use(decoded(draco, new Int8Array(buffer), ids, types))).catch(refuse);
  }

  /** GLTFLoader's type names a class, and only calls two methods. */
  asLoader = () => /** @type {DRACOLoader} */ (/** @type {unknown} */ (this));
}

async function load() {
  const [{ default: start }, answer] = await Promise.all([
    import(`${FOLDER}draco_decoder.js`),
    fetch(new URL(`${FOLDER}draco_decoder.wasm`, import.meta.url)),
  ]);
  return start({ wasmBinary: await answer.arrayBuffer() });
}

/** @param {Draco} draco @param {Int8Array} bytes @param {Record<string, number>} ids @param {Record<string, string>}
 * types */
function decoded(draco, bytes, ids, types) {
  const decoder = new draco.Decoder();
  const mesh = new draco.Mesh();
  try {
    const status = decoder.DecodeArrayToMesh(bytes, bytes.length, mesh);
    if (!status.ok() || mesh.ptr === 0)
      throw new Error(`Draco data cannot be decoded (${status.error_msg()}); export the file again`);
    /** @param {Kind} Type @param {number} length @param {(bytes: number, at: number) => void} fill */
    const copy = (Type, length, fill) => {
      const at = draco._malloc(length * Type.BYTES_PER_ELEMENT);
      fill(length * Type.BYTES_PER_ELEMENT, at);
      const values = new Type(draco.HEAP8.buffer, at, length).slice();
      draco._free(at);
      return values;
    };
    const geometry = new BufferGeometry();
    const triangles = copy(Uint32Array, 3 * mesh.num_faces(), (size, at) =>
      decoder.GetTrianglesUInt32Array(mesh, size, at),
    );
    geometry.setIndex(new BufferAttribute(triangles, 1));
    for (const [name, id] of Object.entries(ids)) {
      if (!(types[name] in TYPES)) continue;
      const attribute = decoder.GetAttributeByUniqueId(mesh, id);
      const [Type, kind] = TYPES[types[name]];
      const values = copy(Type, mesh.num_points() * attribute.num_components(), (size, at) =>
        decoder.GetAttributeDataArrayForAllPoints(mesh, attribute, draco[kind], size, at),
      );
      geometry.setAttribute(name, new BufferAttribute(values, attribute.num_components()));
    }
    return geometry;
  } finally {
    draco.destroy(mesh);
    draco.destroy(decoder);
  }
}
