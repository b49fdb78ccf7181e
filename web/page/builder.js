// Builds memories of dropped files and examples in a worker. A new build ends the one before.

import { Hand } from "./hand.js";

export class Builder {
  constructor(module) {
    this.module = module;
    this.source = 0;
    this.ready = new Hand().start(module);
  }

  // files: [{name, bytes}]. Resolves with what worker.js builds; rejects with the reason, or "cancelled".
  async build(files, options, onStage) {
    if (this.busy) this.cancel();
    if (files !== this.files) this.source++;
    this.files = files;
    const hand = await this.ready;
    this.busy = true;
    try {
      return await hand.call("build", { files, source: this.source, ...options }, onStage);
    } finally {
      if (hand === (await this.ready)) this.busy = false;
    }
  }

  cancel() {
    const { ready } = this;
    this.ready = new Hand().start(this.module);
    this.busy = false;
    ready.then((hand) => hand.stop());
  }
}
