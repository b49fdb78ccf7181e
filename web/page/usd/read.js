// USD files: three.js' loader parses them and puts them together; the files beside this one read of that what voxrt build
// reads. What it does not honour is said in warnings.

import { crateMethods } from "./crate.js";
import { framed, frameMethods, sceneFrame } from "./frames.js";
import { UsdImages } from "./images.js";
import { instancerMethods } from "./instancer.js";
import { UsdMaterials } from "./materials.js";
import { UsdMeshes } from "./meshes.js";
import { ELSEWHERE, referenceMethods } from "./references.js";
import { stageMethods } from "./stage.js";
import { textMethods } from "./text.js";
import { sceneOf } from "../voxrt/scene.js";
import { USDLoader } from "../three/addons/loaders/USDLoader.js";
import { USDAParser } from "../three/addons/loaders/usd/USDAParser.js";
import { USDCParser } from "../three/addons/loaders/usd/USDCParser.js";
import { USDComposer } from "../three/addons/loaders/usd/USDComposer.js";

const MOST_PRIMS = 200_000; // of all layers and copies together

// Specs of a file that say what is not read: kind, message, test of fields and path.
const OTHERS = [
  [
    "collider",
    "colliders are not used here; voxrt build uses them",
    ({ apiSchemas }) => apiSchemas?.includes?.("PhysicsCollisionAPI"),
  ],
  [
    "collection",
    "materials bound to collections are not used here; voxrt build uses them",
    (_, path) => path.includes(".material:binding:collection:"),
  ],
];

export async function readUsd(main, folder, voxrt) {
  const warnings = new Map();
  const warn = (kind, message, count = 1) =>
    warnings.set(message, { kind, message, count: (warnings.get(message)?.count ?? 0) + count });
  const found = {
    warn,
    fields: null,
    moment: null,
    prims: 0,
    open: new Set(),
    charge,
    layer: (file) => layerOf(folder.find(file)),
  };
  const images = new UsdImages(folder, voxrt);
  const meshes = new UsdMeshes(new UsdMaterials(images, voxrt, warn), warn);
  const restored = [patch(USDAParser, textMethods), patch(USDCParser, crateMethods)];
  for (const methods of [stageMethods, referenceMethods, frameMethods, meshes.methods, instancerMethods, layerMethods])
    restored.unshift(patch(USDComposer, methods, found));
  let root;
  try {
    root = new USDLoader().parse(main.bytes.buffer, "");
  } finally {
    for (const restore of restored) restore();
  }
  const frame = sceneFrame(found.fields, warn);
  await images.read();
  meshes.finish();
  root.scale.setScalar(1);
  root.rotation.set(0, 0, 0);
  const scene = sceneOf(root, voxrt, meshes.rules);
  for (const object of scene.objects) object.transform = framed(frame, object.transform);
  scene.warnings = [...scene.warnings, ...warnings.values()].filter(({ count }) => count);
  return scene;
}

// Replace methods of a class; returns what puts the old ones back.
function patch({ prototype }, methodsOf, found) {
  const kept = Object.fromEntries(Object.getOwnPropertyNames(prototype).map((name) => [name, prototype[name]]));
  Object.assign(prototype, methodsOf(kept, found));
  return () => Object.assign(prototype, kept);
}

function charge(place, count) {
  this.prims += count;
  if (this.prims > MOST_PRIMS)
    throw new Error(
      `${place}: more than ${MOST_PRIMS.toLocaleString("en")} prims and copies are too many here; voxrt build takes more`,
    );
}

// A layer that was dropped together with the scene; null for none.
function layerOf(file) {
  if (!file) return null;
  const isCrate = new TextDecoder("latin1").decode(file.bytes.subarray(0, 8)) === "PXR-USDC";
  return (
    isCrate
      ? new USDCParser().parseData(file.bytes.slice().buffer)
      : new USDAParser().parseData(new TextDecoder().decode(file.bytes))
  ).specsByPath;
}

// The outermost methods of a composer: they count, and see what it leaves out.
const layerMethods = (kept, found) => ({
  compose(parsed, ...rest) {
    const { specsByPath } = parsed;
    const { fields } = specsByPath["/"] ?? { fields: {} };
    found.fields = fields;
    found.moment = fields.startTimeCode !== undefined && fields.endTimeCode !== undefined ? fields.startTimeCode : null;
    for (const [path, spec] of Object.entries(specsByPath))
      for (const [kind, message, is] of OTHERS) if (spec.fields && is(spec.fields, path)) found.warn(kind, message);
    if (Object.values(specsByPath).some((spec) => spec.fields?.timeSamples?.times?.length > 1))
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
