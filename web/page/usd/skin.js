// Meshes of USD that a skeleton or blend shapes deform, at the stage's first moment (voxelize/formats/usd/skin.py). Joints
// blend linearly.

import { attributeOf, fieldsOf, namesOf, numbersOf, targetsOf, upwards } from "./stage.js";
import { Matrix4, Object3D, Quaternion, Vector3 } from "../three/three.core.js";
/** @import { Matrix4 as Matrix } from "three" @import { Numbers, Value } from "./stage.js" */
/** @import { Composer } from "./three_private.js" @import { Warn } from "../voxrt/warnings.js" */

/** The points of a mesh; `frame` places them in the mesh's parent, and is null for the mesh's own frame. @typedef {{
 * positions: Numbers, frame: Matrix | null }} Posed */

/** The joints that move points. `each`: per point; `rigid`: whether all points move alike; `matrix`: from the
 * points' frame; `wrong`: whether their counts do not fit. @typedef {{ each: number, rigid: boolean, joints:
 * Numbers, weights: Numbers, matrix: Matrix, wrong: boolean }} Influences */

/** The points of a deformed mesh, or null. @param {Composer} composer @param {string} path @param {Warn} warn */
export function posedPoints(composer, path, warn) {
  const points = numbersOf(composer, path, "points");
  const skeleton = targetAbove(composer, path, "skel:skeleton");
  const isBelowRoot = [...upwards(path)].some((above) => kindOf(composer, above) === "SkelRoot");
  if (!points?.length || !isBelowRoot || !skeleton || kindOf(composer, skeleton) !== "Skeleton") return null;
  const animation = targetAbove(composer, skeleton, "skel:animationSource");
  const blended = Float32Array.from(points);
  const moved = animation !== null && blend(composer, path, animation, blended, warn);
  const influences = influencesOf(composer, path, points.length / 3);
  if (!influences) return moved ? { positions: blended, frame: null } : null;
  const joints = influences.wrong ? null : posedJoints(composer, skeleton, animation);
  const own = /** @type {string[] | null} */ (valueAbove(composer, path, "skel:joints"));
  const order = joints ? (own ? Array.from(own, (name) => joints.get(name)) : [...joints.values()]) : [];
  const used = Array.from(influences.joints, (joint) => order[joint]);
  const known = used.flatMap((matrix) => matrix ?? []);
  if (!joints || known.length < used.length) {
    warn("skinning", "meshes whose skeleton has no pose are shown at rest");
    return moved ? { positions: blended, frame: null } : null;
  }
  if (valueAbove(composer, path, "primvars:skel:skinningMethod") === "dualQuaternion")
    warn("skinning", "dual quaternion skinning was replaced by linear blending");
  return { positions: skinned(blended, known, influences), frame: between(composer, path, skeleton) };
}

/** @param {Composer} composer @param {string} path */
const kindOf = (composer, path) => composer.specsByPath[path]?.fields.typeName;

/** @param {Composer} composer @param {string} path @param {string} name */ function valueAbove(composer, path, name) {
  for (const above of upwards(path)) {
    const value = attributeOf(composer, above, name);
    if (value !== null) return value;
  }
  return null;
}

/** @param {Composer} composer @param {string} path @param {string} name */ function targetAbove(composer, path, name) {
  for (const above of upwards(path)) {
    const [target] = targetsOf(fieldsOf(composer, above, name)?.targetPaths, above);
    if (target) return target;
  }
  return null;
}

/** @param {Composer} composer @param {string} path @param {number} count of points */
function influencesOf(composer, path, count) {
  const joints = valueAbove(composer, path, "primvars:skel:jointIndices");
  const weights = valueAbove(composer, path, "primvars:skel:jointWeights");
  if (!joints?.length || !weights?.length) return null;
  const fields = [...upwards(path)]
    .map((above) => fieldsOf(composer, above, "primvars:skel:jointIndices"))
    .find((found) => found !== null);
  const { elementSize = 1, interpolation = "constant" } = fields ?? {};
  const rigid = interpolation === "constant";
  const bind = valueAbove(composer, path, "primvars:skel:geomBindTransform");
  const [matrix] = matrices(composer, bind, 1) ?? [new Matrix4()];
  const wrong = joints.length !== weights.length || joints.length !== elementSize * (rigid ? 1 : count);
  return { each: elementSize, rigid, joints, weights, matrix, wrong };
}

/** The skinning transform of each joint of a skeleton, by name; null where it has no pose. @param {Composer}
 * composer @param {string} skeleton @param {string | null} animation */
function posedJoints(composer, skeleton, animation) {
  const names = namesOf(composer, skeleton, "joints");
  const [bind, rest] = ["bindTransforms", "restTransforms"].map((name) =>
    matrices(composer, attributeOf(composer, skeleton, name), names.length),
  );
  const local = animated(composer, animation);
  if (!bind || !names.length) return null;
  /** @type {Map<string, Matrix>} */ const placed = new Map();
  /** @type {Map<string, Matrix>} */ const made = new Map();
  for (const [i, name] of names.entries()) {
    const matrix = local.get(name) ?? rest?.[i];
    if (!matrix) return null;
    const above = [...upwards(`/${name}`)].slice(1).map((path) => placed.get(path.slice(1)));
    const parent = above.find((found) => found !== undefined);
    const world = parent ? new Matrix4().multiplyMatrices(parent, matrix) : matrix;
    placed.set(name, world);
    made.set(name, new Matrix4().multiplyMatrices(world, bind[i].invert()));
  }
  return made;
}

/** The joints' transforms below their parents, by name. @param {Composer} composer @param {string | null} animation */
function animated(composer, animation) {
  /** @type {Map<string, Matrix>} */ const made = new Map();
  if (animation === null || kindOf(composer, animation) !== "SkelAnimation") return made;
  const names = namesOf(composer, animation, "joints");
  const read = (/** @type {string} */ name) => numbersOf(composer, animation, name) ?? [];
  const [places, turns, sizes] = ["translations", "rotations", "scales"].map(read);
  if (places.length !== 3 * names.length || turns.length !== 4 * names.length || sizes.length !== 3 * names.length)
    return made;
  for (const [i, name] of names.entries()) {
    const place = new Vector3().fromArray(places, 3 * i);
    const turn = new Quaternion().fromArray(turns, 4 * i).normalize();
    made.set(name, new Matrix4().compose(place, turn, new Vector3().fromArray(sizes, 3 * i)));
  }
  return made;
}

/** @param {Composer} composer @param {Value | null} values @param {number} count */
function matrices(composer, values, count) {
  const flat = values && composer._flattenMatrixArray(Array.from(values), count);
  if (flat?.length !== 16 * count) return null;
  return Array.from({ length: count }, (_, i) => new Matrix4().fromArray(flat, 16 * i));
}

/** Move points. @param {Float32Array} points @param {Matrix[]} moves @param {Influences} influences */
function skinned(points, moves, { each, rigid, weights, matrix }) {
  const made = new Float32Array(points.length);
  const [point, part] = [new Vector3(), new Vector3()];
  for (let i = 0; 3 * i < points.length; i++) {
    point.fromArray(points, 3 * i).applyMatrix4(matrix);
    point.set(Math.fround(point.x), Math.fround(point.y), Math.fround(point.z));
    for (let k = 0; k < each; k++) {
      const at = (rigid ? 0 : each * i) + k;
      if (!weights[at]) continue;
      part.copy(point).applyMatrix4(moves[at]);
      made[3 * i] += Math.fround(Math.fround(part.x) * weights[at]);
      made[3 * i + 1] += Math.fround(Math.fround(part.y) * weights[at]);
      made[3 * i + 2] += Math.fround(Math.fround(part.z) * weights[at]);
    }
  }
  return made;
}

/** Add the blend shapes to points; returns whether an animation gives them weights. @param {Composer} composer
 * @param {string} path @param {string} animation @param {Float32Array} points @param {Warn} warn */
function blend(composer, path, animation, points, warn) {
  const weights = numbersOf(composer, animation, "blendShapeWeights");
  const targets = targetsOf(fieldsOf(composer, path, "skel:blendShapeTargets")?.targetPaths, path);
  if (!weights?.length || !targets.length) return false;
  const factors = new Map(namesOf(composer, animation, "blendShapes").map((name, i) => [name, weights[i]]));
  const names = namesOf(composer, path, "skel:blendShapes");
  for (const [i, target] of targets.entries()) {
    const factor = factors.get(names[i]) ?? 0;
    const offsets = numbersOf(composer, target, "offsets") ?? [];
    const places = numbersOf(composer, target, "pointIndices");
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

/** From a skeleton to a prim's parent. @param {Composer} composer @param {string} path @param {string} skeleton */
function between(composer, path, skeleton) {
  const [from, to] = [[...upwards(skeleton)].reverse(), [...upwards(path)].slice(1).reverse()];
  let shared = 0;
  while (shared < to.length && from[shared] === to[shared]) shared++;
  /** @param {string[]} paths */ const frame = (paths) =>
    paths
      .slice(shared)
      .map((at) => localFrame(composer, at))
      .reduce((made, matrix) => made.multiply(matrix), new Matrix4());
  return frame(to).invert().multiply(frame(from));
}

/** @param {Composer} composer @param {string} path */ function localFrame(composer, path) {
  const object = new Object3D();
  composer.applyTransform(object, composer.specsByPath[path].fields, composer._getAttributes(path));
  return object.matrix;
}
