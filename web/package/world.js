// An octree that is edited: the World of Python, in WebAssembly. An instance of Voxrt has one at a time.
//
//     const editing = await Voxrt.load(await fetch("voxrt_edit.wasm"));
//     const world = new World(editing, built);
//     world.fill({ sphere: { centre: [64, 20, 64], radius: 12 } }, 0); // digs
//     picture.applyPatch(world.commit()); // an instance whose memory was world.image() at the beginning
//
// Errors are VoxrtError, one line each. An edit that fails changes nothing.

import { VoxrtError } from "./instance.js";
/** @import { Material, Triple } from "./scene_format.js" @import { Voxrt } from "./voxrt.js" */

/** Box: whole numbers; `high` is one behind the highest voxel. Spheres and capsules have the voxels whose centres are in
 * them; places and radii are multiples of 1/16 voxel. @typedef {{ box: { low: Triple, high: Triple } } | { sphere: {
 * centre: Triple, radius: number } } | { capsule: { start: Triple, end: Triple, radius: number } }} Shape */

/** What memories elsewhere write: blocks of eight words, then the word of the root at the address `root`, from where they
 * are read then. @typedef {{ root: number, rootWord: number, addresses: Uint32Array, blocks: Uint32Array }} Patch */

/** `beside`: the voxel at the face that the ray crosses; null where the ray begins in a solid voxel. @typedef {{ voxel:
 * number[], beside: number[] | null, material: number }} Picked */

/** Blocks of the octree; further ones that undo, redo and live roots keep; those for the next edits. @typedef {{ blocks:
 * number, kept: number, free: number }} WorldFigures */

const UNIT = 16; // positions per voxel
const REACH = 2 ** 20; // voxels
const MOST_MATERIALS = 255;
const NO_ROOM = -2;

export class World {
  #voxrt;
  #most;
  /** @type {Required<Material>[]} */ #materials;

  /** `words`: the most that the memory may have, of its octree and of what undo and live roots keep. `undoSteps`: edits
   * that can be undone, until their words are needed. @param {Voxrt} voxrt @param {{ words: ArrayLike<number>, depth:
   * number, materials: readonly Required<Material>[] }} memory @param {{ words?: number, undoSteps?: number }} [limits] */
  constructor(voxrt, { words, depth, materials }, { words: most = 2 ** 28 + 1, undoSteps = 100 } = {}) {
    this.#voxrt = voxrt;
    this.#most = most;
    this.#materials = [...materials];
    this.depth = depth;
    voxrt.guard(() =>
      voxrt.with([Uint32Array], [words], (at) =>
        voxrt.checked(voxrt.wasm.vx_world(at, words.length, depth, most, undoSteps)),
      ),
    );
  }

  /** The materials by id; entry 0 is empty space. */
  get materials() {
    return [...this.#materials];
  }

  /** Add a material; one that is there keeps its id. Undo does not remove it. @param {Required<Material>} added */
  addMaterial(added) {
    const known = this.#materials.findIndex((one, id) => id > 0 && isSame(one, added));
    if (known > 0) return known;
    if (this.#materials.length > MOST_MATERIALS)
      throw new VoxrtError(`the world has ${MOST_MATERIALS} materials, which is the most: use one of them`);
    return this.#materials.push(added) - 1;
  }

  /** Edits in a row of one stroke, a whole number other than 0, are undone together. @param {number} number */
  set stroke(number) {
    this.#voxrt.checked(this.#voxrt.wasm.vx_world_stroke(number));
  }

  /** Give voxels their materials; where one repeats, the last counts. @param {ArrayLike<number>} points three whole
   * numbers each @param {ArrayLike<number>} materials ids */
  set(points, materials) {
    for (const id of Array.from(materials)) this.#checkMaterial(id);
    if (points.length !== 3 * materials.length || !Array.from(points).every(Number.isInteger))
      throw new VoxrtError("each voxel must have three whole numbers and a material");
    this.#edit([Int32Array, Uint8Array], [points, materials], (at, ids) =>
      this.#voxrt.wasm.vx_world_set(at, ids, materials.length),
    );
  }

  /** Give the voxels of a shape a material; 0 digs it out. @param {Shape} shape @param {number} material */
  fill(shape, material) {
    this.#checkMaterial(material);
    this.#change(shape, material, false);
  }

  /** Give the solid voxels of a shape a material. @param {Shape} shape @param {number} material */
  paint(shape, material) {
    this.#checkMaterial(material, 1);
    this.#change(shape, material, true);
  }

  /** Back to the voxels before the last edit; false if there is none. */
  undo() {
    return this.#moved(this.#voxrt.wasm.vx_world_undo());
  }

  /** Do again what was undone; false if there is nothing. */
  redo() {
    return this.#moved(this.#voxrt.wasm.vx_world_redo());
  }

  /** Edits that can be undone, and those that can be done again. */
  get steps() {
    return this.#numbers().slice(3, 5);
  }

  /** How the memory is used. @returns {WorldFigures} */
  figures() {
    const [blocks, kept, free] = this.#numbers();
    return { blocks, kept, free };
  }

  /** The first solid voxel on a ray; null if there is none. @param {ArrayLike<number>} origin in 1/16 voxel @param
   * {ArrayLike<number>} direction below 2^20 @returns {Picked | null} */
  pick(origin, direction) {
    return this.#voxrt.with([Int32Array, Int32Array], [origin, direction], (from, to) => {
      const at = this.#found(this.#voxrt.wasm.vx_world_pick(from, to));
      const [material, face, ...voxel] = this.#voxrt.view(Int32Array, at, 5).slice();
      if (!material) return null;
      const beside = voxel.map((place, axis) => (axis === face ? place - Math.sign(direction[axis]) : place));
      return { voxel, beside: face < 3 ? beside : null, material };
    });
  }

  /** Make the octree as it is a live root. A memory that was image() at the beginning, and got every patch, has the
   * octree of each live root. @returns {Patch} */
  commit() {
    const { wasm } = this.#voxrt;
    const count = this.#voxrt.checked(wasm.vx_world_commit());
    return {
      root: wasm.vx_patch_root(),
      rootWord: wasm.vx_patch_root_word() >>> 0,
      addresses: this.#voxrt.view(Uint32Array, wasm.vx_patch_addresses(), count).slice(),
      blocks: this.#voxrt.view(Uint32Array, wasm.vx_patch_blocks(), 8 * count).slice(),
    };
  }

  /** End a live root other than the newest: nothing reads it any more. @param {number} root its address */
  release(root) {
    this.#voxrt.checked(this.#voxrt.wasm.vx_world_release(root));
  }

  /** The words of a build of the voxels as they are. */
  words() {
    return this.#words(false);
  }

  /** All words of the memory, those of free blocks among them. */
  image() {
    return this.#words(true);
  }

  /** Free the memory of the world, which cannot be used after that. */
  end() {
    this.#voxrt.wasm.vx_world_end();
  }

  /** @param {boolean} image */ #words(image) {
    return this.#voxrt.guard(() => {
      const count = this.#voxrt.checked(this.#voxrt.wasm.vx_world_words(image));
      return this.#voxrt.view(Uint32Array, this.#voxrt.wasm.vx_world_words_at(), count).slice();
    });
  }

  #numbers() {
    return [...this.#voxrt.view(Float64Array, this.#found(this.#voxrt.wasm.vx_world_figures()), 5)];
  }

  /** The address that a call returned; 0 where it has failed. @param {number} at */ #found(at) {
    this.#voxrt.checked(at || -1);
    return at;
  }

  /** @param {Shape} shape @param {number} material @param {boolean} solidOnly */ #change(shape, material, solidOnly) {
    const { wasm } = this.#voxrt;
    if ("box" in shape) {
      const { low, high } = shape.box;
      if (![...low, ...high].every((part) => Number.isInteger(part) && Math.abs(part) <= REACH))
        throw new VoxrtError("the corners of a box must be whole numbers up to 2**20");
      if (low.some((part, axis) => part > high[axis]))
        throw new VoxrtError("a box must have its low corner below high");
      this.#edit([Int32Array, Int32Array], [low, high], (from, to) => wasm.vx_world_box(from, to, material, solidOnly));
    } else if ("sphere" in shape) {
      const [centre, radius] = [units(shape.sphere.centre), radiusOf(shape.sphere.radius)];
      this.#edit([Int32Array], [centre], (at) => wasm.vx_world_ball(at, radius, material, solidOnly));
    } else {
      const [start, end] = [shape.capsule.start, shape.capsule.end].map(units);
      const radius = radiusOf(shape.capsule.radius);
      this.#edit([Int32Array, Int32Array], [start, end], (from, to) =>
        wasm.vx_world_capsule(from, to, radius, material, solidOnly),
      );
    }
  }

  /** @param {Parameters<Voxrt["with"]>[0]} kinds @param {ArrayLike<number>[]} arrays @param {(...at: number[]) =>
   * number} edit */
  #edit(kinds, arrays, edit) {
    const fits = this.#voxrt.guard(() => this.#voxrt.with(kinds, arrays, (...at) => this.#voxrt.checked(edit(...at))));
    if (!fits) throw this.#noRoom();
  }

  /** @param {number} answer of a step */ #moved(answer) {
    if (answer === NO_ROOM) throw this.#noRoom();
    return this.#voxrt.checked(answer) > 0;
  }

  /** @param {number} id @param {number} [low] */ #checkMaterial(id, low = 0) {
    if (!Number.isInteger(id) || id < low || id >= this.#materials.length)
      throw new VoxrtError(`material must be ${low} … ${this.#materials.length - 1}, not ${id}`);
  }

  #noRoom() {
    const most = this.#most.toLocaleString("en");
    return new VoxrtError(`the result of the edit does not fit the ${most} words of the world's memory`);
  }
}

/** @param {Material} one @param {Material} other */ const isSame = (one, other) =>
  one.name === other.name &&
  one.mirror === other.mirror &&
  one.authored === other.authored &&
  one.colour.every((part, channel) => part === other.colour[channel]);

/** @param {Triple} place */ function units(place) {
  const whole = place.map((part) => UNIT * part);
  if (!whole.every((part) => Number.isInteger(part) && Math.abs(part) <= UNIT * REACH))
    throw new VoxrtError(`a place must have multiples of 1/16 voxel up to 2**20, not ${place}`);
  return whole;
}

/** @param {number} radius */ function radiusOf(radius) {
  const [whole] = units([radius]);
  if (whole < 0) throw new VoxrtError(`a radius must be 0 or more, not ${radius}`);
  return whole;
}
