// A worker as a hand of the page: calls that answer, stages that it reports, and an end that always works.

export class Hand {
  constructor(script = "./worker.js") {
    Object.assign(this, { script, calls: new Map() });
  }

  async start(module) {
    this.worker = new Worker(new URL(this.script, import.meta.url), { type: "module" });
    this.worker.onmessage = ({ data }) => this.answer(data);
    this.worker.onerror = (event) => {
      event.preventDefault();
      for (const { reject } of this.calls.values()) reject(new Error(event.message || "the worker has failed"));
      this.calls.clear();
    };
    await this.call("start", { module });
    return this;
  }

  call(call, given = {}, onStage = () => {}, moved = []) {
    const id = (this.last = (this.last ?? 0) + 1);
    return new Promise((resolve, reject) => {
      this.calls.set(id, { resolve, reject, onStage });
      this.worker.postMessage({ id, call, ...given }, moved);
    });
  }

  answer({ id, result, problem, stage }) {
    const waiting = this.calls.get(id);
    if (!waiting) return;
    if (stage) return void waiting.onStage(stage);
    this.calls.delete(id);
    if (problem === undefined) waiting.resolve(result);
    else waiting.reject(new Error(problem));
  }

  // End it in the middle of whatever it does.
  stop() {
    this.worker.terminate();
    for (const { reject } of this.calls.values()) reject(new Error("cancelled"));
    this.calls.clear();
  }
}
