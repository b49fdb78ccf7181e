// Meshes that are compressed by Draco, for GLTFLoader: Google's decoder, loaded when a file needs it.

import { BufferAttribute, BufferGeometry } from "./three/three.core.js";

const FOLDER = "./three/draco/";
const TYPES = {
  Float32Array: [Float32Array, "DT_FLOAT32"],
  Int8Array: [Int8Array, "DT_INT8"],
  Uint8Array: [Uint8Array, "DT_UINT8"],
  Int16Array: [Int16Array, "DT_INT16"],
  Uint16Array: [Uint16Array, "DT_UINT16"],
  Uint32Array: [Uint32Array, "DT_UINT32"],
};

export class DracoDecoder {
  preload() {}

  // What GLTFLoader calls. `ids`: of attributes by name; `types`: the names of their arrays.
  decodeDracoFile(buffer, use, ids, types, _space, refuse) {
    this.library ??= load();
    this.library.then((draco) => use(decoded(draco, new Int8Array(buffer), ids, types))).catch(refuse);
  }
}

async function load() {
  const [{ default: start }, answer] = await Promise.all([
    import(`${FOLDER}draco_decoder.js`),
    fetch(new URL(`${FOLDER}draco_decoder.wasm`, import.meta.url)),
  ]);
  return start({ wasmBinary: await answer.arrayBuffer() });
}

function decoded(draco, bytes, ids, types) {
  const decoder = new draco.Decoder();
  const mesh = new draco.Mesh();
  try {
    const status = decoder.DecodeArrayToMesh(bytes, bytes.length, mesh);
    if (!status.ok() || mesh.ptr === 0)
      throw new Error(`Draco data cannot be decoded (${status.error_msg()}); export the file again`);
    const copy = (Type, length, fill) => {
      const at = draco._malloc(length * Type.BYTES_PER_ELEMENT);
      fill(length * Type.BYTES_PER_ELEMENT, at);
      const values = new Type(draco.HEAP8.buffer, at, length).slice();
      draco._free(at);
      return values;
    };
    const geometry = new BufferGeometry();
    geometry.setIndex(
      new BufferAttribute(
        copy(Uint32Array, 3 * mesh.num_faces(), (size, at) => decoder.GetTrianglesUInt32Array(mesh, size, at)),
        1,
      ),
    );
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
