// "Bitstream": the placed design of a board with the memory that is shown, as voxrt bitstream makes it.

import { save } from "./downloads.js";
import { $ } from "./elements.js";
import { Hand } from "./hand.js";
import { PLAIN } from "./mem.js";

export class BoardPanel {
  // `app`: as of main.js. `module`: voxrt.wasm, compiled.
  constructor(app, module) {
    Object.assign(this, { app, module, hand: null });
    $("bitstream-cancel").onclick = () => this.hand?.stop();
  }

  // A button for a board that the memory fits.
  button(board) {
    const button = Object.assign(document.createElement("button"), {
      type: "button",
      textContent: "Bitstream",
      title: "Fits: a file for openFPGALoader that shows this memory on a monitor, turning",
    });
    button.setAttribute("aria-label", `Bitstream for ${board}`);
    button.onclick = () => this.make(board);
    return button;
  }

  async make(board) {
    this.hand?.stop();
    const { name, words, depth, materials, lighting } = this.app.memory();
    const hand = new Hand("./board_worker.js");
    this.hand = hand;
    $("bitstream").hidden = false;
    $("bitstream-progress").removeAttribute("value");
    this.running(true);
    this.say(`${board}: counting the clocks of pictures from all around …`);
    try {
      await hand.start(this.module);
      const made = await hand.call(
        "bitstream",
        { name: board, words, depth, materials, lighting: lighting ?? PLAIN },
        ({ share }) => {
          $("bitstream-progress").value = share;
        },
      );
      save(made.bits, `${name}.bit`);
      const late = made.lead < 0 ? "; some rows are repeated, because the next ones are late" : "";
      const dark = made.missing.length
        ? `; left out, since the board has no hardware for it: ${made.missing.join(", ")}`
        : "";
      this.say(
        `${board}: ${made.width}×${made.height}, ${made.framesPerSecond.toFixed(1)} frames per second${late}${dark}. Load it: openFPGALoader --board ${made.loader} ${name}.bit`,
      );
    } catch (error) {
      if (this.hand === hand)
        this.say(error.message === "cancelled" ? "" : error.message, error.message !== "cancelled");
    }
    hand.stop();
    if (this.hand !== hand) return;
    this.hand = null;
    this.running(false);
  }

  running(on) {
    $("bitstream-progress").hidden = !on;
    $("bitstream-cancel").hidden = !on;
  }

  say(text, bad = false) {
    $("bitstream-says").textContent = text;
    $("bitstream-says").classList.toggle("large", bad);
  }
}
