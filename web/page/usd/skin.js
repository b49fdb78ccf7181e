// Meshes of USD that a skeleton or blend shapes deform, at the stage's first moment (voxelize/formats/usd/skin.py). Joints
// blend linearly.

import { fieldsOf, targetsOf, upwards, valueOf } from "./stage.js";
import { Matrix4, Object3D, Quaternion, Vector3 } from "../three/three.core.js";

// The points of a mesh: {positions, frame}, where frame places them in the mesh's parent, or null for the mesh's own
// frame. null for meshes at rest.
export function posedPoints(composer, path, warn) {
  const points = valueOf(composer, path, "points");
  const skeleton = targetAbove(composer, path, "skel:skeleton");
  const isBelowRoot = [...upwards(path)].some((above) => composer.specsByPath[above]?.fields.typeName === "SkelRoot");
  if (!points?.length || !isBelowRoot || composer.specsByPath[skeleton]?.fields.typeName !== "Skeleton") return null;
  const animation = targetAbove(composer, skeleton, "skel:animationSource");
  const blended = Float32Array.from(points);
  const moved = blend(composer, path, animation, blended, warn);
  const influences = influencesOf(composer, path, points.length / 3);
  if (!influences) return moved ? { positions: blended, frame: null } : null;
  const joints = influences.wrong ? null : posedJoints(composer, skeleton, animation);
  const own = valueAbove(composer, path, "skel:joints");
  const order = joints && own ? Array.from(own, (name) => joints.get(name)) : joints && [...joints.values()];
  if (!order || !influences.fits(order)) {
    warn("skinning", "meshes whose skeleton has no pose are shown at rest");
    return moved ? { positions: blended, frame: null } : null;
  }
  if (valueAbove(composer, path, "primvars:skel:skinningMethod") === "dualQuaternion")
    warn("skinning", "dual quaternion skinning was replaced by linear blending");
  return { positions: skinned(blended, order, influences), frame: between(composer, path, skeleton) };
}

function valueAbove(composer, path, name) {
  for (const above of upwards(path)) {
    const value = valueOf(composer, above, name);
    if (value !== null) return value;
  }
  return null;
}

function targetAbove(composer, path, name) {
  for (const above of upwards(path)) {
    const [target] = targetsOf(fieldsOf(composer, above, name)?.targetPaths, above);
    if (target) return target;
  }
  return null;
}

function influencesOf(composer, path, count) {
  const [joints, weights] = ["Indices", "Weights"].map((name) =>
    valueAbove(composer, path, `primvars:skel:joint${name}`),
  );
  if (!joints?.length || !weights?.length) return null;
  const above = [...upwards(path)].find((at) => fieldsOf(composer, at, "primvars:skel:jointIndices"));
  const { elementSize = 1, interpolation = "constant" } = fieldsOf(composer, above, "primvars:skel:jointIndices");
  const rigid = interpolation === "constant";
  const [matrix] = matrices(composer, valueAbove(composer, path, "primvars:skel:geomBindTransform"), 1) ?? [
    new Matrix4(),
  ];
  return {
    each: elementSize,
    rigid,
    joints,
    weights,
    matrix,
    wrong: joints.length !== weights.length || joints.length !== elementSize * (rigid ? 1 : count),
    fits: (order) => joints.every((joint) => order[joint]),
  };
}

// The skinning transform of each joint of a skeleton, by name; null where it has no pose.
function posedJoints(composer, skeleton, animation) {
  const names = Array.from(valueOf(composer, skeleton, "joints") ?? []);
  const [bind, rest] = ["bindTransforms", "restTransforms"].map((name) =>
    matrices(composer, valueOf(composer, skeleton, name), names.length),
  );
  const local = animated(composer, animation);
  if (!bind || !names.length) return null;
  const [placed, made] = [new Map(), new Map()];
  for (const [i, name] of names.entries()) {
    const matrix = local.get(name) ?? (rest && rest[i]);
    if (!matrix) return null;
    const parent = [...upwards(`/${name}`)]
      .slice(1)
      .map((above) => placed.get(above.slice(1)))
      .find(Boolean);
    placed.set(name, parent ? new Matrix4().multiplyMatrices(parent, matrix) : matrix);
    made.set(name, new Matrix4().multiplyMatrices(placed.get(name), bind[i].invert()));
  }
  return made;
}

// The transforms of joints below their parents that an animation gives, by name.
function animated(composer, animation) {
  const made = new Map();
  if (composer.specsByPath[animation]?.fields.typeName !== "SkelAnimation") return made;
  const names = Array.from(valueOf(composer, animation, "joints") ?? []);
  const [places, turns, sizes] = ["translations", "rotations", "scales"].map(
    (name) => valueOf(composer, animation, name) ?? [],
  );
  if (places.length !== 3 * names.length || turns.length !== 4 * names.length || sizes.length !== 3 * names.length)
    return made;
  for (const [i, name] of names.entries())
    made.set(
      name,
      new Matrix4().compose(
        new Vector3().fromArray(places, 3 * i),
        new Quaternion().fromArray(turns, 4 * i).normalize(),
        new Vector3().fromArray(sizes, 3 * i),
      ),
    );
  return made;
}

function matrices(composer, values, count) {
  const flat = values && composer._flattenMatrixArray(Array.from(values), count);
  return flat?.length === 16 * count
    ? Array.from({ length: count }, (_, i) => new Matrix4().fromArray(flat, 16 * i))
    : null;
}

function skinned(points, order, { each, rigid, joints, weights, matrix }) {
  const made = new Float32Array(points.length);
  const [point, part] = [new Vector3(), new Vector3()];
  for (let i = 0; 3 * i < points.length; i++) {
    point.fromArray(points, 3 * i).applyMatrix4(matrix);
    point.set(Math.fround(point.x), Math.fround(point.y), Math.fround(point.z));
    for (let k = 0; k < each; k++) {
      const at = (rigid ? 0 : each * i) + k;
      if (!weights[at]) continue;
      part.copy(point).applyMatrix4(order[joints[at]]);
      made[3 * i] += Math.fround(Math.fround(part.x) * weights[at]);
      made[3 * i + 1] += Math.fround(Math.fround(part.y) * weights[at]);
      made[3 * i + 2] += Math.fround(Math.fround(part.z) * weights[at]);
    }
  }
  return made;
}

// Adds the blend shapes to points; returns whether an animation gives them weights.
function blend(composer, path, animation, points, warn) {
  const weights = animation && valueOf(composer, animation, "blendShapeWeights");
  const targets = targetsOf(fieldsOf(composer, path, "skel:blendShapeTargets")?.targetPaths, path);
  if (!weights?.length || !targets.length) return false;
  const factors = new Map(
    Array.from(valueOf(composer, animation, "blendShapes") ?? [], (name, i) => [name, weights[i]]),
  );
  const names = Array.from(valueOf(composer, path, "skel:blendShapes") ?? []);
  for (const [i, target] of targets.entries()) {
    const factor = factors.get(names[i]) ?? 0;
    const offsets = valueOf(composer, target, "offsets") ?? [];
    const places = valueOf(composer, target, "pointIndices");
    if ([...(composer.attributesByPrimPath.get(target)?.keys() ?? [])].some((name) => name.startsWith("inbetweens:")))
      warn("skinning", "shapes in between of blend shapes are not used here; voxrt build uses them");
    if (!factor) continue;
    for (let at = 0; 3 * at < offsets.length; at++) {
      const to = 3 * (places?.length ? places[at] : at);
      for (let axis = 0; axis < 3; axis++)
        if (to + axis < points.length) points[to + axis] += Math.fround(offsets[3 * at + axis] * factor);
    }
  }
  return true;
}

// From the frame of a skeleton to that of a prim's parent.
function between(composer, path, skeleton) {
  const [from, to] = [[...upwards(skeleton)].reverse(), [...upwards(path)].slice(1).reverse()];
  let shared = 0;
  while (shared < to.length && from[shared] === to[shared]) shared++;
  const frame = (paths) =>
    paths
      .slice(shared)
      .map((at) => localFrame(composer, at))
      .reduce((made, matrix) => made.multiply(matrix), new Matrix4());
  return frame(to).invert().multiply(frame(from));
}

function localFrame(composer, path) {
  const object = new Object3D();
  composer.applyTransform(object, composer.specsByPath[path].fields, composer._getAttributes(path));
  return object.matrix;
}
