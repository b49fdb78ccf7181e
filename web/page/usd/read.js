// USD files: three.js' loader parses them and puts them together; the files beside this one read of that what voxrt build
// reads. Warnings name what they do not honour.

import { USDLoader } from "../three/addons/loaders/USDLoader.js";
import { USDAParser } from "../three/addons/loaders/usd/USDAParser.js";
import { USDCParser } from "../three/addons/loaders/usd/USDCParser.js";
import { sceneOf } from "../voxrt/scene.js";
import { Warnings } from "../voxrt/warnings.js";
import { crateMethods } from "./crate.js";
import { framed, frameMethods, sceneFrame } from "./frames.js";
import { UsdImages } from "./images.js";
import { instancerMethods } from "./instancer.js";
import { UsdMaterials } from "./materials.js";
import { UsdMeshes } from "./meshes.js";
import { ELSEWHERE, referenceMethods } from "./references.js";
import { stageMethods } from "./stage.js";
import { textMethods } from "./text.js";
import { MEMBERS, patch } from "./three_private.js";
/** @import { Reader } from "../files.js" @import { DroppedFile, Folder } from "../folder.js" */
/** @import { Warn } from "../voxrt/warnings.js" @import { Fields, Found, Spec } from "./stage.js" */
/** @import { Composer, MethodsOf } from "./three_private.js" */

const MOST_PRIMS = 200_000; // of all layers and copies together

/** @type {[string, string, (fields: Fields, path: string) => boolean][]} kind, subject and test */ const OTHERS = [
  ["collider", "colliders are", ({ apiSchemas = [] }) => apiSchemas.includes("PhysicsCollisionAPI")],
  ["rule", "rules of prims are", (_, path) => path.endsWith(".voxrt:rule")],
  ["fill", "fills of prims are", (_, path) => path.endsWith(".voxrt:fill")],
  ["collection", "materials bound to collections are", (_, path) => path.includes(".material:binding:collection:")],
];

/** @type {Reader} */ export async function readUsd(main, folder, voxrt) {
  const warnings = new Warnings();
  const found = foundBy(warnings.warn, folder);
  const images = new UsdImages(folder, voxrt);
  const meshes = new UsdMeshes(new UsdMaterials(images, voxrt, warnings.warn), warnings.warn);
  const composing = [stageMethods, referenceMethods, frameMethods].map((methods) => methods(found));
  const restored = [
    patch(MEMBERS.USDAParser, [textMethods]),
    patch(MEMBERS.USDCParser, [crateMethods]),
    patch(MEMBERS.USDComposer, [...composing, meshes.methods, instancerMethods(found), layerMethods(found)]),
  ];
  let root;
  try {
    root = new USDLoader().parse(main.bytes.buffer, "");
  } finally {
    for (const restore of restored) restore();
  }
  const frame = sceneFrame(found.fields, warnings.warn);
  await images.read();
  meshes.finish();
  root.scale.setScalar(1);
  root.rotation.set(0, 0, 0);
  const scene = sceneOf(root, voxrt, meshes.rules);
  for (const object of scene.objects) object.transform = framed(frame, object.transform);
  scene.warnings.push(...warnings.list());
  return scene;
}

/** @param {Warn} warn @param {Folder} folder @returns {Found} */ function foundBy(warn, folder) {
  let prims = 0;
  return {
    warn,
    fields: {},
    moment: null,
    open: new Set(),
    charge: (place, count) => {
      prims += count;
      if (prims <= MOST_PRIMS) return;
      const most = MOST_PRIMS.toLocaleString("en");
      throw new Error(`${place}: more than ${most} prims and copies are too many here; voxrt build takes more`);
    },
    layer: (file) => layerOf(folder.find(file)),
  };
}

/** The specs of a layer that was dropped too; null for none. @param {DroppedFile | undefined} file */
function layerOf(file) {
  if (!file) return null;
  const isCrate = new TextDecoder("latin1").decode(file.bytes.subarray(0, 8)) === "PXR-USDC";
  const parsed = isCrate
    ? new USDCParser().parseData(file.bytes.slice().buffer)
    : new USDAParser().parseData(new TextDecoder().decode(file.bytes));
  return parsed.specsByPath;
}

/** @param {Spec} spec */ const isAnimated = ({ fields }) => (fields?.timeSamples?.times?.length ?? 0) > 1;

/** The outermost methods: they count, and see what is left out. @param {Found} found @returns {MethodsOf<Composer>} */
const layerMethods = (found) => (kept) => ({
  compose(parsed, ...rest) {
    const { specsByPath } = parsed;
    const { fields } = specsByPath["/"] ?? { fields: {} };
    found.fields = fields;
    const { startTimeCode, endTimeCode } = fields;
    found.moment = startTimeCode !== undefined && endTimeCode !== undefined ? startTimeCode : null;
    for (const [path, spec] of Object.entries(specsByPath))
      for (const [kind, what, is] of OTHERS)
        if (spec.fields && is(spec.fields, path)) found.warn(kind, `${what} not used here; voxrt build uses them`);
    if (Object.values(specsByPath).some(isAnimated))
      found.warn("animation", "animated layers are shown at the stage's start");
    return kept.compose.call(this, parsed, ...rest);
  },
  _resolveReference: () => null, // references.js has followed them
  _buildHierarchy(parent, path) {
    found.charge(path, 1);
    const fields = this.specsByPath[path]?.fields ?? {};
    if (ELSEWHERE.some((name) => name in fields))
      found.warn("reference", "references to files that are not here, and to prims that do not exist, were left out");
    kept._buildHierarchy.call(this, parent, path);
  },
});
