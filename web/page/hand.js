// A worker as a hand of the page: calls that answer, stages that it reports, and an end that always works.

/** @import { Reply } from "./worker_answers.js" */

/** What a worker can be asked, by name: it takes what was sent, and a function that reports a stage. @typedef {{
 * [name: string]: (job: never, report: never) => unknown }} Calls */

/** @typedef {{ resolve: (result: never) => void, reject: (error: Error) => void, onStage: ((stage: never) => void) |
 * undefined }} Waiting */

/** @template {Calls} C */
export class Hand {
  /** @type {Map<number, Waiting>} */ #calls = new Map();
  #last = 0;

  /** @param {string} script */ constructor(script) {
    const type = script.startsWith("blob:") ? "classic" : "module"; // pages from a disk start no modules of a blob
    this.worker = new Worker(new URL(script, import.meta.url), { type });
    this.worker.onmessage = ({ data }) => this.#answer(data);
    this.worker.onerror = (event) => {
      event.preventDefault();
      this.#fail(event.message || "the worker has failed");
    };
  }

  /** @template {keyof C & string} N @param {N} call @param {Parameters<C[N]>[0]} job @param {Parameters<C[N]>[1]}
   * [onStage] @param {Transferable[]} [transfer] @returns {Promise<Awaited<ReturnType<C[N]>>>} */
  call(call, job, onStage, transfer = []) {
    const id = ++this.#last;
    return new Promise((resolve, reject) => {
      this.#calls.set(id, { resolve, reject, onStage });
      this.worker.postMessage({ id, call, job }, transfer);
    });
  }

  /** @param {Reply} reply */ #answer({ id, result, problem, stage }) {
    const waiting = this.#calls.get(id);
    if (!waiting) return;
    if (stage) {
      waiting.onStage?.(stage);
      return;
    }
    this.#calls.delete(id);
    if (problem === undefined) waiting.resolve(result);
    else waiting.reject(new Error(problem));
  }

  /** @param {string} problem */ #fail(problem) {
    for (const { reject } of this.#calls.values()) reject(new Error(problem));
    this.#calls.clear();
  }

  /** End it in the middle of whatever it does. */
  stop() {
    this.worker.terminate();
    this.#fail("cancelled");
  }
}
