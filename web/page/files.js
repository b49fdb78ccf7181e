// Dropped files as a scene: three.js parses them. Nothing is fetched but the files themselves.

import { sceneOf } from "./voxrt/scene.js";
import { GltfLooks } from "./gltf_looks.js";

export const FORMATS = ["glb", "gltf", "obj", "stl", "ply", "usdz", "usda", "usdc", "usd", "vox", "mem"];
const ADDONS = "./three/addons/";

export class FileError extends Error {
  name = "FileError";
}

const extension = (name) => name.slice(name.lastIndexOf(".") + 1).toLowerCase();
const stem = (name) => name.slice(0, name.lastIndexOf("."));

// The first scene that no other one names: layers of USD refer to each other.
function sceneAmong(files) {
  const scenes = files.filter(({ name }) => FORMATS.includes(extension(name)));
  const texts = scenes.map(({ name, bytes }) =>
    scenes.length > 1 && extension(name).startsWith("usd") ? new TextDecoder("latin1").decode(bytes) : "",
  );
  return (
    scenes.find(({ name }) => !texts.some((text, i) => scenes[i].name !== name && text.includes(name))) ?? scenes[0]
  );
}

// Read files ({name, bytes}), one of which is a scene. Returns {name, file, scene} or {name, file, memory}.
export async function readFiles(files, voxrt) {
  const main = sceneAmong(files);
  if (!main)
    throw new FileError(
      `${files[0]?.name ?? "nothing"}: is no scene; drop ${FORMATS.map((format) => `.${format}`).join(", ")}`,
    );
  const known = { name: stem(main.name), file: main.name };
  const kind = extension(main.name);
  try {
    if (kind === "mem") {
      const { readMem } = await import("./read_mem.js");
      const memory = readMem(
        main,
        files.find(({ name }) => name === `${stem(main.name)}.json`),
      );
      return { ...known, memory: { ...memory, depth: memory.depth ?? voxrt.depthOf(memory.words) } };
    }
    if (kind === "vox") {
      const { readVox } = await import("./vox.js");
      return { ...known, memory: readVox(main.name, main.bytes, voxrt) };
    }
    const read = { glb: readGltf, gltf: readGltf, obj: readObj, stl: readStl, ply: readPly }[kind] ?? readUsd;
    const scene = await read(main, new Folder(main, files), voxrt);
    if (!scene.objects.length) throw new FileError("has no triangles to voxelize; check that the scene shows a mesh");
    return { ...known, scene };
  } catch (error) {
    const problem = String(error?.message ?? error).split("\n")[0];
    throw new FileError(problem.startsWith(main.name) ? problem : `${main.name}: ${problem}`);
  }
}

function decoded(name) {
  try {
    return decodeURIComponent(name);
  } catch {
    return name; // a plain name with "%"
  }
}

// The files beside a scene, for the loaders of three.js: names that are not among them are refused.
class Folder {
  constructor(main, files) {
    this.main = main;
    this.files = new Map(files.map((file) => [file.name.toLowerCase(), file]));
    this.urls = [];
    this.missing = [];
  }

  find(name) {
    const plain = decoded(name).replaceAll("\\", "/").replace(/^.*\//, "");
    return this.files.get(plain.toLowerCase());
  }

  async manager() {
    const { LoadingManager } = await import("./three/three.core.js");
    const manager = new LoadingManager();
    manager.setURLModifier((url) => {
      if (url.startsWith("blob:") || url.startsWith("data:")) return url;
      const file = this.find(url);
      if (!file) {
        this.missing.push(url);
        return "data:application/octet-stream;base64,";
      }
      this.urls.push(URL.createObjectURL(new Blob([file.bytes])));
      return this.urls.at(-1);
    });
    return manager;
  }

  close() {
    for (const url of this.urls) URL.revokeObjectURL(url);
    if (this.missing.length)
      throw new FileError(`${this.main.name}: needs ${this.missing[0]}; drop it together with the scene`);
  }
}

const addon = async (path) => import(`${ADDONS}${path}.js`);

async function readGltf(main, folder, voxrt) {
  const { GLTFLoader } = await addon("loaders/GLTFLoader");
  const loader = new GLTFLoader(await folder.manager());
  const { MeshoptDecoder } = await addon("libs/meshopt_decoder.module");
  loader.setMeshoptDecoder(MeshoptDecoder);
  const { DracoDecoder } = await import("./draco.js");
  loader.setDRACOLoader(new DracoDecoder());
  const looks = new GltfLooks(folder);
  const { Texture } = await import("./three/three.core.js");
  for (const name of GltfLooks.loaders)
    loader.register((parser) => ({ name, loadTexture: (index) => looks.placeholder(parser, index, new Texture()) }));
  let gltf;
  try {
    gltf = await loader.parseAsync(main.bytes.buffer, "");
  } catch (error) {
    folder.close();
    throw error;
  }
  folder.close();
  const { parser } = gltf;
  const { json } = parser;
  await looks.read(parser);
  const place = (object, kind) => (parser.associations.get(object) ?? {})[kind];
  // The primitives of a mesh hang below its node, or are the node.
  const groupOf = (mesh) => (place(mesh, "nodes") === undefined && mesh.parent ? mesh.parent : mesh);
  const nodeOf = (group) => place(group, "nodes");
  const named = (group) =>
    json.nodes[nodeOf(group)]?.name ||
    json.meshes?.[json.nodes[nodeOf(group)]?.mesh]?.name ||
    `nodes[${nodeOf(group)}]`;
  const counts = new Map();
  gltf.scene.traverse((object) => {
    if (
      (object.isMesh && groupOf(object) === object) ||
      (object.isGroup && object.children.some((child) => child.isMesh && groupOf(child) === object))
    )
      counts.set(named(object), (counts.get(named(object)) ?? 0) + 1);
  });
  const scene = sceneOf(gltf.scene, voxrt, {
    groupOf,
    nameOf: (_mesh, group) =>
      counts.get(named(group)) > 1 ? `${named(group)} (nodes[${nodeOf(group)}])` : named(group),
    materialOf: (material) => {
      const index = place(material, "materials");
      if (index === undefined) return null;
      const extras = json.materials[index].extras ?? {};
      const { name, factor, mirror } = looks.properties(index);
      return {
        key: extras.voxrt_material ? `${name} ${mirror}` : index,
        order: index,
        name,
        mirror,
        colour: factor.slice(0, 3).map((channel) => voxrt.srgb(channel)),
      };
    },
    isLeftOut: (material) => looks.isLeftOut(place(material, "materials")),
    appearanceOf: (material, geometry) => looks.appearance(place(material, "materials"), geometry),
  });
  scene.warnings.push(...looks.warnings.values());
  const ignored = (json.extensionsUsed ?? []).filter((name) => /^KHR_(physics|implicit|materials_variants)/.test(name));
  for (const name of ignored)
    scene.warnings.push({ kind: "extension", message: `${name} is not used here; voxrt build uses it`, count: 1 });
  return scene;
}

// Text of UTF-16 where it begins with its mark, else of UTF-8, else of Windows-1252, which old exporters wrote.
function textOf(bytes) {
  const mark = { 0xfeff: "utf-16be", 0xfffe: "utf-16le" }[(bytes[0] << 8) | bytes[1]];
  try {
    return new TextDecoder(mark ?? "utf-8", { fatal: !mark }).decode(bytes);
  } catch {
    return new TextDecoder("windows-1252").decode(bytes);
  }
}

async function readObj(main, folder, voxrt) {
  const [{ code, objLooks }, { withoutConcave }] = [await import("./obj_looks.js"), await import("./polygons.js")];
  const [{ OBJLoader }, { MTLLoader }] = [await addon("loaders/OBJLoader"), await addon("loaders/MTLLoader")];
  const text = textOf(main.bytes);
  const library = new Map();
  for (const [, name] of text.matchAll(/^\s*mtllib\s+(.+?)\s*$/gm)) {
    const file = folder.find(name);
    if (!file) continue;
    const { materialsInfo } = new MTLLoader().parse(textOf(file.bytes), "");
    for (const [key, info] of Object.entries(materialsInfo)) if (!library.has(key)) library.set(key, info);
  }
  const root = new OBJLoader().parse(withoutConcave(text));
  const looks = await objLooks(library, folder, voxrt);
  const scene = sceneOf(root, voxrt, {
    nameOf: (mesh) => mesh.name || stem(main.name),
    materialOf: ({ name }) => {
      const { kd } = library.get(name) ?? {};
      if (!name || (!kd && !text.includes("usemtl"))) return null;
      return { key: name, name, colour: kd ? kd.map(code) : [200, 200, 200] };
    },
    ...(/^\s*vn\s/m.test(text) ? {} : { normalsOf: () => null }), // OBJLoader makes some of its own
    ...looks.rules,
  });
  scene.warnings.push(...looks.warnings);
  return scene;
}

async function bare(geometry, main, voxrt, rules = { appearanceOf: () => null }) {
  const { Mesh } = await import("./three/three.core.js");
  const mesh = new Mesh(geometry);
  mesh.name = stem(main.name);
  return sceneOf(mesh, voxrt, { materialOf: () => null, ...rules });
}

async function readStl(main, _folder, voxrt) {
  const { STLLoader } = await addon("loaders/STLLoader");
  return bare(new STLLoader().parse(main.bytes.buffer), main, voxrt, {
    appearanceOf: () => null,
    normalsOf: () => null,
  }); // its normals are those of the faces
}

// Where only the last line of a header ends with "\r\n", PLYLoader would start with the data a byte early.
function withoutReturn(bytes) {
  const header = new TextDecoder("latin1").decode(bytes.subarray(0, 1 << 16));
  const at = header.indexOf("end_header\r\n") + "end_header".length;
  if (!header.startsWith("ply\n") || header[at] !== "\r") return bytes;
  const made = new Uint8Array(bytes.length - 1);
  made.set(bytes.subarray(0, at));
  made.set(bytes.subarray(at + 1), at);
  return made;
}

async function readPly(main, folder, voxrt) {
  const { plyLook, readsColours } = await import("./ply_look.js");
  const { PLYLoader } = await addon("loaders/PLYLoader");
  const geometry = readsColours(new PLYLoader()).parse(withoutReturn(main.bytes).buffer);
  const { rules, warnings } = await plyLook(main.bytes, geometry, folder, voxrt);
  const scene = await bare(geometry, main, voxrt, rules);
  scene.warnings.push(...warnings);
  return scene;
}

async function readUsd(main, folder, voxrt) {
  const usd = await import("./usd/read.js");
  return usd.readUsd(main, folder, voxrt);
}
