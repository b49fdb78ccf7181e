// How the page's workers answer: hand.js has the other end.

/** @import { Calls } from "./hand.js" */

/** @typedef {{ id: number, result: never, problem?: string, stage?: never }} Reply */
/** @param {number} number */ export const count = (number) => number.toLocaleString("en");

/** Answer calls. Pixels and colours of a result are moved, not copied. @param {Calls} calls */
export function answerWith(calls) {
  addEventListener("message", async ({ data: { id, call, job } }) => {
    try {
      const report = (/** @type {unknown} */ stage) => postMessage({ id, stage });
      const result = /** @type {{ pixels?: Uint8Array, colour?: Uint8Array } | undefined} */ (
        await calls[call](/** @type {never} */ (job), /** @type {never} */ (report))
      );
      const pixels = result?.pixels ?? result?.colour;
      postMessage({ id, result }, { transfer: pixels ? [pixels.buffer] : [] });
    } catch (error) {
      const text = error instanceof Error ? error.message : String(error);
      postMessage({ id, problem: text.split("\n")[0] });
    }
  });
}
