// glTF files: GLTFLoader parses them, and the looks are read by the file's own numbers.

import { DracoDecoder } from "./draco.js";
import { FileError } from "./folder.js";
import { GltfLooks } from "./gltf_looks.js";
import { MeshoptDecoder } from "./three/addons/libs/meshopt_decoder.module.js";
import { GLTFLoader } from "./three/addons/loaders/GLTFLoader.js";
import { LoadingManager, Texture } from "./three/three.core.js";
import { sceneOf } from "./voxrt/scene.js";
import { FILLS, RULES } from "./voxrt/voxrt.js";
/** @import { Material, Object3D } from "three" @import { Reader } from "./files.js" */
/** @import { DroppedFile, Folder } from "./folder.js" @import { GltfParser } from "./gltf_looks.js" */

/** @type {Reader} */ export async function readGltf(main, folder, voxrt) {
  const looks = new GltfLooks(folder);
  const { scene: root, parser } = await parse(main, folder, looks);
  const { json } = parser;
  await looks.read(parser);
  /** @param {Material | Object3D} object @param {"nodes" | "materials"} kind */
  const place = (object, kind) => parser.associations.get(object)?.[kind];
  /** The primitives of a mesh hang below its node, or are the node. @param {Object3D} mesh */
  const groupOf = (mesh) => (place(mesh, "nodes") === undefined && mesh.parent ? mesh.parent : mesh);
  /** @param {Object3D} group */ const nameOf = (group) => {
    const node = place(group, "nodes") ?? -1;
    return json.nodes?.[node]?.name || json.meshes?.[json.nodes?.[node]?.mesh ?? -1]?.name || `nodes[${node}]`;
  };
  /** @type {Map<string, number>} objects by name */ const counts = new Map();
  root.traverse((object) => {
    const isOwn = (/** @type {Object3D} */ mesh) => "isMesh" in mesh && groupOf(mesh) === object;
    if (!isOwn(object) && !("isGroup" in object && object.children.some(isOwn))) return;
    counts.set(nameOf(object), (counts.get(nameOf(object)) ?? 0) + 1);
  });
  const scene = sceneOf(root, voxrt, {
    groupOf,
    nameOf: (_mesh, group) => {
      const name = nameOf(group);
      return (counts.get(name) ?? 0) > 1 ? `${name} (nodes[${place(group, "nodes")}])` : name;
    },
    choicesOf: (group) => {
      const { voxrt_rule: rule, voxrt_fill: fill } = json.nodes?.[place(group, "nodes") ?? -1]?.extras ?? {};
      return { rule: oneOf(RULES, "rule", rule), fill: oneOf(FILLS, "fill", fill) };
    },
    materialOf: (material) => {
      const index = place(material, "materials");
      if (index === undefined) return null;
      const { name, factor, mirror, isNamed } = looks.properties(index);
      const colour = factor.slice(0, 3).map((channel) => voxrt.srgb(channel));
      return { key: isNamed ? `${name} ${mirror}` : index, order: index, name, mirror, colour };
    },
    leavesOut: (material) => looks.leavesOut(place(material, "materials")),
    appearanceOf: (material, geometry) => looks.appearance(place(material, "materials"), geometry),
  });
  scene.warnings.push(...looks.warnings.list());
  for (const name of json.extensionsUsed ?? [])
    if (/^KHR_(physics|implicit|materials_variants)/.test(name))
      scene.warnings.push({ kind: "extension", message: `${name} is not used here; voxrt build uses it`, count: 1 });
  return scene;
}

/** @template {string} T @param {readonly T[]} choices @param {string} name @param {unknown} value */
function oneOf(choices, name, value) {
  const known = choices.find((one) => one === value) ?? null;
  if (value !== undefined && !known)
    throw new FileError(`${JSON.stringify(value)} is no ${name}; name one of ${choices.join(", ")}`);
  return known;
}

/** @param {DroppedFile} main @param {Folder} folder @param {GltfLooks} looks @returns {Promise<{ scene: Object3D,
 * parser: GltfParser }>} */
async function parse(main, folder, looks) {
  /** @type {string[]} */ const urls = [];
  /** @type {string[]} */ const missing = [];
  const manager = new LoadingManager();
  manager.setURLModifier((url) => {
    if (url.startsWith("blob:") || url.startsWith("data:")) return url;
    const file = folder.find(url);
    if (!file) {
      missing.push(url);
      return "data:application/octet-stream;base64,";
    }
    const made = URL.createObjectURL(new Blob([file.bytes]));
    urls.push(made);
    return made;
  });
  const loader = new GLTFLoader(manager);
  loader.setMeshoptDecoder(MeshoptDecoder);
  loader.setDRACOLoader(new DracoDecoder().asLoader());
  for (const name of GltfLooks.loaders)
    loader.register((parser) => ({ name, loadTexture: (index) => looks.placeholder(parser, index, new Texture()) }));
  try {
    return await loader.parseAsync(main.bytes.buffer, "");
  } finally {
    for (const url of urls) URL.revokeObjectURL(url);
    // biome-ignore lint/correctness/noUnsafeFinally: a missing file is why parsing failed
    if (missing.length) throw new FileError(`${main.name}: needs ${missing[0]}; drop it together with the scene`);
  }
}
