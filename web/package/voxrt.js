// voxrt in WebAssembly: meshes to voxels, to the words of an octree memory, to exact pictures. One instance has one scene,
// one memory and one frame at a time. Nothing here needs a page: it runs in browsers, workers and Node.
//
//     const voxrt = await Voxrt.load(await fetch("voxrt.wasm"));
//     const built = voxrt.voxelize(scene, { depth: 7 });
//     voxrt.setMemory(built.words, built.depth);
//     voxrt.shade({ materials: built.materials.map((material) => material.colour) });
//     const { colour } = voxrt.render(camera, [640, 480]);
//
// Errors are VoxrtError, one line each.

import { Instance, VoxrtError } from "./instance.js";
import { opaque } from "./pixels.js";
import { voxelize } from "./voxelize.js";

export * from "./scene_format.js";
export { VoxrtError };

/** @import { Built, Options, Scene, Triple } from "./scene_format.js" @import { Patch } from "./world.js" */

/** The camera registers: direction(column, row) = look + right (column - W/2) + up (H/2 - row). `position`: in 1/16
 * voxel; `look`: whole numbers below 2^15, as those of right and up. @typedef {{ position: Triple, look: Triple,
 * right: Triple, up: Triple }} Camera */

/** @typedef {readonly number[]} Size columns and rows */

/** How hits are coloured. `materials`: sRGB by id; entry 0 is the background; `mirrors`: ids; `faces`: 1/255, of the
 * faces that look along -x, +x, -y, +y, -z, +z; null: by the angle; `light`: position in 1/16 voxel, ambient 0 …
 * 255. @typedef {{ materials: readonly ArrayLike<number>[], mirrors?: readonly number[], bounces?: number, flat?:
 * boolean, faces?: ArrayLike<number> | null, light?: { position: Triple, ambient: number } | null }} Look */

/** `top`: the first row of pixels; `colour`: RGB, row by row; `face`: the axis of the face hit; 3 for none. @typedef
 * {{ top: number, colour: Uint8Array, material: Uint8Array, face: Uint8Array, wordsRead: number }} Rows */

/** `level`: the word's octant has 2^level voxels per side; `axis`: of the plane that the ray crossed last; 3 for
 * none. @typedef {{ address: number, word: number, level: number, corner: number[], axis: number }} Reading */

/** @typedef {{ readings: Reading[], material: number, face: number, cell: number[] | null }} Followed */

/** Brightness, in 1/255, of the faces that look along -x, +x, -y, +y, -z, +z: the default shading. */
export const FACES = [189, 189, 140, 255, 219, 219];
export const BACKGROUND = [24, 28, 36];
const TILE = 16; // rows of pixels

/** Colours by material id, as the modules take them. @param {readonly ArrayLike<number>[]} materials */
export function colourTable(materials) {
  const table = new Uint8Array(768);
  for (const [id, colour] of materials.entries()) table.set(colour, 3 * id);
  return table;
}

export class Voxrt extends Instance {
  /** Voxelize a scene and build its octree. @param {Scene} scene @param {Options} [options] @returns {Built} */
  voxelize(scene, options = {}) {
    return voxelize(this, scene, options);
  }

  /** The words of voxels given one by one. Where a place repeats, the first counts. @param {ArrayLike<number>}
   * places three whole numbers from 0 up to 2^depth each @param {ArrayLike<number>} materials 1 … 255 @param
   * {number} depth */
  fromPoints(places, materials, depth) {
    const arrays = [places, materials];
    return this.guard(() =>
      this.with([Int32Array, Uint8Array], arrays, (at, ids) => {
        const count = this.checked(this.wasm.vx_points(at, ids, materials.length, depth));
        return this.view(Uint32Array, this.wasm.vx_points_words(), count).slice();
      }),
    );
  }

  /** Take the words of an octree memory, which are checked. @param {ArrayLike<number>} words @param {number} depth */
  setMemory(words, depth) {
    this.guard(() =>
      this.with([Uint32Array], [words], (at) => this.checked(this.wasm.vx_memory(at, words.length, depth))),
    );
  }

  /** Write a patch of World.commit() into the memory, whose voxels then are those of the commit. @param {Patch} patch */
  applyPatch({ root, rootWord, addresses, blocks }) {
    this.guard(() =>
      this.with([Uint32Array, Uint32Array], [addresses, blocks], (places, words) =>
        this.checked(this.wasm.vx_patch(places, words, addresses.length, root, rootWord)),
      ),
    );
  }

  /** The least depth of the world that words describe. @param {ArrayLike<number>} words */
  depthOf(words) {
    return this.guard(() =>
      this.with([Uint32Array], [words], (at) => this.checked(this.wasm.vx_depth(at, words.length))),
    );
  }

  /** The fewest levels by which the memory must be coarser to have so many words. @param {number} words */
  levelThatFits(words) {
    return this.guard(() => this.checked(this.wasm.vx_level_that_fits(words)));
  }

  /** Set how hits are coloured. @param {Look} look */
  shade({ materials, mirrors = [], bounces = 0, flat = false, faces = FACES, light = null }) {
    const flags = new Uint8Array(256);
    for (const id of mirrors) flags[id] = 1;
    const arrays = [colourTable(materials), flags, faces ?? [], light?.position ?? []];
    this.guard(() =>
      this.with([Uint8Array, Uint8Array, Uint8Array, Int32Array], arrays, (colours, mirrored, brightness, place) => {
        const lit = [faces && !flat ? brightness : 0, light ? place : 0, light?.ambient ?? 0];
        return this.wasm.vx_shading(colours, mirrored, bounces, flat, ...lit);
      }),
    );
  }

  /** Render a frame, or its rows of tiles `first` up to and without `end`; a tile is 16 pixels high. Returns copies.
   * @param {Camera} camera @param {Size} size @returns {Rows} */
  render(camera, [width, height], first = 0, end = this.tileRows(height)) {
    return this.guard(() => {
      const wordsRead = this.#trace(camera, width, height, first, end);
      const [top, bottom] = [TILE * first, Math.min(TILE * end, height)];
      /** @param {number} at @param {number} bytes */ const part = (at, bytes) =>
        this.view(Uint8Array, at + top * width * bytes, (bottom - top) * width * bytes).slice();
      const [material, face] = [part(this.wasm.vx_frame_material(), 1), part(this.wasm.vx_frame_face(), 1)];
      return { top, wordsRead, colour: part(this.wasm.vx_colour(), 3), material, face };
    });
  }

  /** The same for a canvas: RGBA as ImageData takes it. @param {Camera} camera @param {Size} size @param {number}
   * [first] @param {number} [end] @param {ArrayBuffer | null} [buffer] for the pixels, which is used if it has the
   * right size */
  renderImage(camera, [width, height], first = 0, end = this.tileRows(height), buffer = null) {
    return this.guard(() => {
      this.#trace(camera, width, height, first, end);
      const top = TILE * first;
      const count = (Math.min(TILE * end, height) - top) * width;
      const pixels = buffer?.byteLength === 4 * count ? new Uint32Array(buffer) : new Uint32Array(count);
      opaque(this.view(Uint8Array, this.wasm.vx_colour() + 3 * top * width, 3 * count), pixels);
      return { top, pixels: new Uint8ClampedArray(pixels.buffer) };
    });
  }

  /** @param {Camera} camera @param {number} width @param {number} height @param {number} first @param {number} end */
  #trace({ position, look, right, up }, width, height, first, end) {
    return this.with([Int32Array], [[...position, ...look, ...right, ...up]], (at) =>
      this.checked(this.wasm.vx_render(at, width, height, first, end)),
    );
  }

  /** How many rows of tiles a frame has. @param {number} height */
  tileRows(height) {
    return this.wasm.vx_tile_rows(height);
  }

  /** Follow one ray: each word that it reads, and what it hits. @param {ArrayLike<number>} origin in 1/16 voxel
   * @param {ArrayLike<number>} direction below 2^20 @returns {Followed} */
  follow(origin, direction) {
    const arrays = [origin, direction];
    return this.guard(() => {
      const count = this.with([Int32Array, Int32Array], arrays, (from, to) =>
        this.checked(this.wasm.vx_follow(from, to)),
      );
      const all = this.view(Int32Array, this.wasm.vx_readings(), 7 * count + 5).slice();
      const readings = Array.from({ length: count }, (_, i) => {
        const [address, word, level, x, y, z, axis] = all.subarray(7 * i, 7 * i + 7);
        return { address: address >>> 0, word: word >>> 0, level, corner: [x, y, z], axis };
      });
      const [material, face, x, y, z] = all.subarray(7 * count);
      return { readings, material, face, cell: material ? [x, y, z] : null };
    });
  }

  /** The voxels of the memory by material: 256 numbers, entry 0 the empty ones. */
  voxels() {
    return this.guard(() => [...this.view(Float64Array, this.wasm.vx_voxel_counts(), 256)]);
  }

  /** Cubes around all that is solid, 1/64 of the world or more: x, y, z of the lowest corner and the side. */
  outline() {
    return this.guard(() => {
      const count = this.checked(this.wasm.vx_outline());
      return this.view(Int32Array, this.wasm.vx_outline_leaves(), 4 * count).slice();
    });
  }

  /** Linear light, 0 … 1, as sRGB, 0 … 255. @param {number} linear */
  srgb(linear) {
    return this.wasm.vx_srgb(linear);
  }

  /** sRGB, 0 … 255, as linear light. @param {number} code */
  linear(code) {
    return this.wasm.vx_linear(code);
  }
}
