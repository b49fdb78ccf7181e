// The voxels of the server's scene, for who walks on them: boxes around the body, fetched before it leaves them. What is
// not known yet is solid.

import { isInside } from "./brush.js";
import { meetsSolid } from "./solids.js";
import { subtract } from "./vectors.js";
/** @import { App } from "./app.js" @import { Box } from "./camera.js" @import { Solid } from "./connection.js" */
/** @import { Octree } from "./solids.js" @import { Vector } from "./vectors.js" */

const REACH = 64; // voxels around the body
const LEAST = 2;
const STEP = 16; // boxes begin and end at whole octants of this side: they are cut out quickly, and are small

/** `version`: of the voxels. @typedef {{ box: Box, version: string, octree: Octree }} Known */

export class ServedGround {
  /** @type {Known | null} */ #known = null;
  /** @type {Box | null} the newest box within it */ #newest = null;
  #reach = REACH;
  #isFetching = false;
  tallest = 48; // a box of this body, and what it can reach, has few words

  /** @param {App} app */ constructor(app) {
    this.app = app;
  }

  get scene() {
    return this.app.isReady() ? this.app.state().scene.number : null;
  }

  get voxelSize() {
    return this.app.state().scene.voxel_size ?? null;
  }

  /** Other voxels have another one. */
  get #version() {
    const { scene, view } = this.app.state();
    return `${scene.number} ${scene.edits?.number} ${view.frame}`;
  }

  /** @param {Box} box */ async prepare(box) {
    this.#reach = REACH;
    this.#known = await this.#fetch(box);
    this.#newest = box;
  }

  /** @param {Vector} low @param {Vector} high */ meets(low, high) {
    const [known, half] = [this.#known, this.#reach / 2];
    const isKnown = known !== null && isInside([low, high], known.box);
    const around = /** @type {Box} */ ([low.map((part) => part - half), high.map((part) => part + half)]);
    if (!isKnown || known.version !== this.#version || !isInside(around, known.box)) this.#renew([low, high]);
    if (!isKnown) return true;
    this.#newest = [low, high];
    return meetsSolid(known.octree, subtract(low, known.box[0]), subtract(high, known.box[0]));
  }

  /** @param {Vector} origin @param {Vector} direction */ async hit(origin, direction) {
    const { hit } = await this.app.connection.request("ray", { origin, direction });
    return { cell: hit?.voxel ?? null, face: hit?.face ?? null };
  }

  /** @param {Box} box */ async #renew(box) {
    if (this.#isFetching) return;
    this.#isFetching = true;
    try {
      const fetched = await this.#fetch(box);
      if (isInside(this.#newest ?? box, fetched.box)) this.#known = fetched;
    } catch (error) {
      this.app.walker?.fail(/** @type {Error} */ (error).message);
    }
    this.#isFetching = false;
  }

  /** A box with as much around it as the server sends. @param {Box} box @returns {Promise<Known>} */
  async #fetch(box) {
    const version = this.#version;
    const [low, high] = [
      box[0].map((part) => STEP * Math.floor((part - this.#reach) / STEP)),
      box[1].map((part) => STEP * Math.ceil((part + this.#reach) / STEP)),
    ];
    try {
      const { solid } = await this.app.connection.request("solid", { low, high });
      return { box: [low, high], version, octree: octreeOf(solid) };
    } catch (error) {
      if (this.#reach <= LEAST || !this.app.isReady()) throw error;
      this.#reach /= 2;
      return this.#fetch(box);
    }
  }
}

/** @param {Solid} solid @returns {Octree} */ function octreeOf({ depth, words }) {
  const bytes = Uint8Array.from(atob(words), (character) => character.charCodeAt(0));
  const all = new Uint32Array(bytes.buffer);
  return { words: all, depth, root: all[0] };
}
