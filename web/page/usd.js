// USD files by three.js, with their textures, and what of them it does not honour.

import { decodeImage } from "./images.js";
import { isInstancer, placeCopies } from "./usd_instancer.js";
import { sceneOf } from "./voxrt/scene.js";
import { ImageLoader } from "./three/three.core.js";
import { USDLoader } from "./three/addons/loaders/USDLoader.js";
import { USDComposer } from "./three/addons/loaders/usd/USDComposer.js";

const MISSING = "textures that are missing or of an unsupported format were replaced by the default colour";
const OTHERS = [
  ["collider", "colliders are not used here; voxrt build uses them", ({ apiSchemas }) => /Physics\w*Collision/.test(JSON.stringify(apiSchemas ?? ""))],
  ["inactive", "parts that are not active are not left out here; voxrt build leaves them out", ({ active }) => active === false],
  ["opacity", "opacity is not used here; voxrt build uses it", (fields, path) => /\.inputs:opacity(Threshold)?$/.test(path) && (fields.connectionPaths || fields.default < 1)],
];

export async function readUsd(main, folder, voxrt) {
  const found = watch(folder);
  try {
    const root = await new Promise((resolve, reject) => new USDLoader().parse(main.bytes.buffer, "", resolve, reject));
    const scene = sceneOf(root, voxrt);
    const warnings = OTHERS.map(([kind, message, is]) => ({ kind, message, count: Object.entries(found.specs).filter(([path, { fields }]) => fields && is(fields, path)).length }));
    scene.warnings = scene.warnings.filter(({ kind }) => kind !== "texture");
    warnings.push(
      { kind: "missing-texture", message: MISSING, count: found.missing },
      { kind: "invisible", message: "masked copies of point instancers were left out", count: found.masked },
      { kind: "instancer", message: "point instancers whose prototypes are not below them are left out here; voxrt build reads them", count: found.elsewhere },
      { kind: "instancer", message: "masks of point instancers that cannot be read here were not used; voxrt build uses them", count: found.unread },
    );
    scene.warnings.push(...warnings.filter(({ count }) => count));
    return scene;
  } finally {
    found.close();
  }
}

// The loader decodes images by elements of a page, which workers have not; here images.js does. And it keeps what it
// parsed to itself.
function watch(folder) {
  const [{ load }, { compose, _buildHierarchy }] = [ImageLoader.prototype, USDComposer.prototype];
  const close = () => { Object.assign(ImageLoader.prototype, { load }); Object.assign(USDComposer.prototype, { compose, _buildHierarchy }); };
  const found = { specs: {}, missing: 0, masked: 0, unread: 0, elsewhere: 0, copied: 0, close };
  USDComposer.prototype.compose = function (parsed, ...rest) {
    found.specs = parsed.specsByPath;
    return compose.call(this, parsed, ...rest);
  };
  USDComposer.prototype._buildHierarchy = function (parent, path) {
    const build = (object, below) => _buildHierarchy.call(this, object, below);
    if (isInstancer(this, path)) placeCopies(this, parent, path, build, found);
    else build(parent, path);
  };
  ImageLoader.prototype.load = (url, onLoad) => {
    imageAt(url, folder).then(({ width, height, pixels }) => onLoad({ width, height, data: pixels }), () => {
      found.missing++;
      onLoad(undefined);
    });
  };
  return found;
}

async function imageAt(url, folder) {
  if (url.startsWith("blob:")) return decodeImage(new Uint8Array(await (await fetch(url)).arrayBuffer()), "texture");
  const file = folder.find(url);
  if (!file) throw new Error(`no ${url}`);
  return decodeImage(file.bytes, file.name);
}
