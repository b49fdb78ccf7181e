// Builds memories of dropped files and examples in a worker. A new build ends the one before.

import { Hand } from "./hand.js";
/** @import { DroppedFile } from "./folder.js" @import { Memory } from "./memory.js" */
/** @import { Stage } from "./build_notice.js" @import { BuildCalls, BuildOptions } from "./build_worker.js" */
/** @import { Placing } from "./placing.js" */

export class Builder {
  #source = 0;
  #busy = false;
  /** @type {DroppedFile[] | null} */ #files = null;

  /** @param {WebAssembly.Module} module */ constructor(module) {
    this.module = module;
    this.ready = this.#start();
  }

  async #start() {
    /** @type {Hand<BuildCalls>} */ const hand = new Hand("./build_worker.js");
    await hand.call("start", { module: this.module });
    return hand;
  }

  /** Rejects with the reason, or "cancelled". @param {DroppedFile[]} files @param {BuildOptions & Placing} options @param
   * {(stage: Stage) => void} onStage */
  async build(files, options, onStage) {
    if (this.#busy) this.cancel();
    if (files !== this.#files) this.#source++;
    this.#files = files;
    const hand = await this.ready;
    this.#busy = true;
    try {
      return await hand.call("build", { files, source: this.#source, ...options }, onStage);
    } finally {
      if (hand === (await this.ready)) this.#busy = false;
    }
  }

  cancel() {
    const { ready } = this;
    this.ready = this.#start();
    this.#busy = false;
    ready.then((hand) => hand.stop());
  }
}
