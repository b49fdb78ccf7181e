// MagicaVoxel files: coloured voxels of every instance of every model. z is up there and y here: voxel (x, y, z) goes to
// (x, z, -y), a rotation.

import { dot } from "./vectors.js";
import { BACKGROUND } from "./voxrt/voxrt.js";
import { DAMAGED, readChunks } from "./vox_chunks.js";
/** @import { Memory } from "./memory.js" @import { VoxFile } from "./vox_chunks.js" */
/** @import { Voxrt, Warning } from "./voxrt/voxrt.js" */

/** @typedef {{ model: number, rows: number[][], offset: number[] }} Instance */
const VOXEL_LIMIT = 1 << 25;
const INSTANCE_LIMIT = 1 << 16;
const NESTING_LIMIT = 256;
const DEPTH_LIMIT = 16;
const IDENTITY = [0, 1, 2].map((row) => [0, 1, 2].map((column) => Number(row === column)));

/** @param {string} name @param {Uint8Array} bytes @param {Voxrt} voxrt */ export function readVox(name, bytes, voxrt) {
  const file = readChunks(name, bytes);
  const { instances, warnings } = instancesOf(name, file);
  const total = instances.reduce((sum, { model }) => sum + file.models[model].voxels.length / 4, 0);
  if (!total) throw new Error(`${name}: holds no visible voxel; show at least one model`);
  if (total > VOXEL_LIMIT)
    throw new Error(`${name}: ${total} voxels, and ${VOXEL_LIMIT} are the most; save fewer instances`);
  const places = new Float64Array(3 * total);
  const colours = new Uint8Array(total);
  let at = 0;
  for (const { model, rows, offset } of instances) {
    const { size, voxels } = file.models[model];
    for (let i = 0; i < voxels.length; i += 4, at++) {
      const centre = size.map((side, axis) => 2 * (voxels[i + axis] - (side >> 1)) + 1);
      const [x, y, z] = rows.map((row, axis) => Math.floor((dot(row, centre) + 2 * offset[axis]) / 2));
      places.set([x, z, -1 - y], 3 * at);
      colours[at] = voxels[i + 3];
    }
  }
  const [low, high] = [Array(3).fill(Infinity), Array(3).fill(-Infinity)];
  places.forEach((value, i) => {
    low[i % 3] = Math.min(low[i % 3], value);
    high[i % 3] = Math.max(high[i % 3], value);
  });
  const span = Math.max(...low.map((value, axis) => high[axis] - value)) + 1;
  const depth = Math.max(1, Math.ceil(Math.log2(span)));
  if (depth > DEPTH_LIMIT)
    throw new Error(`${name}: ${span} voxels from end to end do not fit depth ${DEPTH_LIMIT}; move the parts closer`);
  const used = [...new Set(colours)].sort((a, b) => a - b);
  const ids = new Map(used.map((colour, i) => [colour, i + 1]));
  const moved = places.map((value, i) => value - low[i % 3]);
  const words = voxrt.fromPoints(
    moved,
    colours.map((colour) => ids.get(colour) ?? 0),
    depth,
  );
  /** @param {string} name @param {readonly number[]} colour */
  const plain = (name, colour) => ({ name, colour, mirror: false, authored: true });
  const shown = used.map((colour) => plain(`colour ${colour}`, file.palette(colour)));
  const materials = [plain("empty", BACKGROUND), ...shown];
  const kinds = used.flatMap((colour) => file.kinds.get(colour) ?? []);
  const names = [...new Set(kinds)].sort().map((kind) => kind.replaceAll("_", ""));
  if (names.length) {
    const message = `${names.join(", ")} materials became plain colours`;
    warnings.push({ kind: "vox-material", message, count: kinds.length });
  }
  return { words, depth, materials, objects: [], grid: null, warnings };
}

const FIRST_FRAME = "only the first frame of what is animated is shown";

/** The instances of the scene graph; without one, the models are frames. @param {string} name @param {VoxFile} file */
function instancesOf(name, file) {
  if (!file.nodes.size) {
    const warnings =
      file.models.length > 1 ? [{ kind: "vox-animation", message: FIRST_FRAME, count: file.models.length - 1 }] : [];
    return {
      instances: file.models.slice(0, 1).map(() => ({ model: 0, rows: IDENTITY, offset: [0, 0, 0] })),
      warnings,
    };
  }
  /** @type {Instance[]} */ const instances = [];
  let [hidden, animated, visited] = [0, 0, 0];
  /** @type {{ number: number, rows: number[][], offset: number[], above: number[] }[]} */
  const waiting = [{ number: 0, rows: IDENTITY, offset: [0, 0, 0], above: [] }];
  for (let next = waiting.pop(); next; next = waiting.pop()) {
    const { number, rows, offset, above } = next;
    const node = file.nodes.get(number);
    visited++;
    if (!node || above.includes(number))
      throw new Error(`${name}: scene node ${number}: ${node ? "holds itself" : "is not there"}; ${DAMAGED}`);
    if (visited > INSTANCE_LIMIT || above.length > NESTING_LIMIT)
      throw new Error(
        `${name}: more than ${INSTANCE_LIMIT} scene nodes, or ${NESTING_LIMIT} in one another; save fewer`,
      );
    const here = [...above, number];
    if ("child" in node) {
      if (node.hidden || file.hidden.has(node.layer)) {
        hidden++;
        continue;
      }
      if (node.frames > 1) animated++;
      const columns = [0, 1, 2].map((column) => node.rows.map((row) => row[column]));
      const local = rows.map((row) => columns.map((column) => dot(row, column)));
      const moved = rows.map((row, axis) => dot(row, node.offset) + offset[axis]);
      waiting.push({ number: node.child, rows: local, offset: moved, above: here });
    } else if ("children" in node) {
      for (const child of [...node.children].reverse()) waiting.push({ number: child, rows, offset, above: here });
    } else {
      if (node.models.length > 1) animated++;
      const [model] = node.models;
      if (!node.models.length || node.models.some((one) => one < 0 || one >= file.models.length))
        throw new Error(`${name}: scene node ${number}: shows no model of 0 ... ${file.models.length - 1}; ${DAMAGED}`);
      instances.push({ model, rows, offset });
    }
  }
  /** @type {Warning[]} */ const warnings = [];
  if (hidden) warnings.push({ kind: "vox-hidden", message: "nodes that the author hid are left out", count: hidden });
  if (animated) warnings.push({ kind: "vox-animation", message: FIRST_FRAME, count: animated });
  return { instances, warnings };
}
