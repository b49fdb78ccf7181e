// "Bitstream": the placed design of a board with the memory that is shown, as voxrt bitstream makes it.

import { $, element } from "./elements.js";
import { Hand } from "./hand.js";
import { PLAIN } from "./memory.js";
import { save } from "./save.js";
/** @import { App } from "./app.js" @import { BoardCalls } from "./board_worker.js" */

export class BoardPanel {
  /** @type {Hand<BoardCalls> | null} */ #hand = null;

  /** @param {App} app @param {WebAssembly.Module} module voxrt.wasm */ constructor(app, module) {
    this.app = app;
    this.module = module;
    $("bitstream-cancel").onclick = () => this.#hand?.stop();
  }

  /** A button for a board that the memory fits. @param {string} board */
  button(board) {
    const title = "Fits: a file for openFPGALoader that shows this memory on a monitor, turning";
    const onclick = () => this.#make(board);
    return element("button", { type: "button", title, onclick, "aria-label": `Bitstream for ${board}` }, "Bitstream");
  }

  /** @param {string} board */ async #make(board) {
    this.#hand?.stop();
    const memory = await this.app.settled();
    if (!memory) return;
    const { name, words, depth, materials, lighting } = memory;
    /** @type {Hand<BoardCalls>} */ const hand = new Hand("./board_worker.js");
    this.#hand = hand;
    $("bitstream").hidden = false;
    $("bitstream-progress").removeAttribute("value");
    this.#showRunning(true);
    this.#say(`${board}: counting the clocks of pictures from all around …`);
    const job = { module: this.module, name: board, words, depth, materials, lighting: lighting ?? PLAIN };
    try {
      const made = await hand.call("bitstream", job, ({ share }) => {
        $("bitstream-progress").value = share;
      });
      save(new Blob([made.bits]), `${name}.bit`);
      const late = made.lead < 0 ? "; some rows are repeated, because the next ones are late" : "";
      const missing = made.missing.join(", ");
      const dark = missing && `; left out, since the board has no hardware for it: ${missing}`;
      const speed = `${made.width}×${made.height}, ${made.framesPerSecond.toFixed(1)} frames per second`;
      this.#say(`${board}: ${speed}${late}${dark}. Load it: openFPGALoader --board ${made.loader} ${name}.bit`);
    } catch (error) {
      const { message } = /** @type {Error} */ (error);
      const cancelled = message === "cancelled";
      if (this.#hand === hand) this.#say(cancelled ? "" : message, !cancelled);
    }
    hand.stop();
    if (this.#hand !== hand) return;
    this.#hand = null;
    this.#showRunning(false);
  }

  /** @param {boolean} on */ #showRunning(on) {
    $("bitstream-progress").hidden = !on;
    $("bitstream-cancel").hidden = !on;
  }

  /** @param {string} text */ #say(text, bad = false) {
    $("bitstream-says").textContent = text;
    $("bitstream-says").classList.toggle("large", bad);
  }
}
