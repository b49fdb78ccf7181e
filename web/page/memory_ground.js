// The voxels of the memory that is shown, with all edits, for who walks on them.

import { meetsSolid } from "./solids.js";
/** @import { App } from "./app.js" @import { Editor } from "./editor.js" @import { Vector } from "./vectors.js" */

export class MemoryGround {
  /** @type {Editor | null} */ editor = null;
  tallest = Infinity;

  /** @param {App} app */ constructor(app) {
    this.app = app;
  }

  get scene() {
    return this.app.memory();
  }

  get voxelSize() {
    return this.scene?.grid?.voxelSize ?? null;
  }

  async prepare() {}

  /** @param {Vector} low @param {Vector} high */ meets(low, high) {
    const memory = this.scene;
    return memory !== null && meetsSolid(this.editor?.words ?? { ...memory, root: memory.words[0] }, low, high);
  }

  /** @param {Vector} origin @param {Vector} direction */ hit(origin, direction) {
    return this.app.painter.follow(origin, direction);
  }
}
