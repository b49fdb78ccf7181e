// "Run the real hardware": the verilated ray tracer renders the view once, clock by clock, and the page holds its
// picture against the model's.

import { toRegisters } from "./camera.js";
import { $, showFacts } from "./elements.js";
import { Hand } from "./hand.js";
/** @import { App } from "./app.js" @import { Compared, HardwareCalls } from "./hardware_worker.js" */

const [WIDTH, HEIGHT] = [320, 240];
/** @param {number} number */ const count = (number) => number.toLocaleString("en");

export class HardwarePanel {
  /** @type {Hand<HardwareCalls> | null} */ #hand = null;

  /** @param {App} app @param {WebAssembly.Module} module voxrt.wasm */ constructor(app, module) {
    this.app = app;
    this.module = module;
    $("run-hardware").onclick = () => (this.#hand ? this.#hand.stop() : this.#run());
  }

  async #run() {
    const [memory, view] = [await this.app.settled(), this.app.view()];
    if (!memory || !view) return;
    /** @type {Hand<HardwareCalls>} */ const hand = new Hand("./hardware_worker.js");
    this.#hand = hand;
    $("run-hardware").textContent = "Cancel";
    $("hardware-progress").hidden = false;
    $("hardware-progress").removeAttribute("value");
    this.#say("Loading the hardware …");
    try {
      await hand.call("start", { module: this.module });
      this.#say("Running …");
      const { words, depth, name } = memory;
      const size = [WIDTH, HEIGHT];
      const job = { words, depth, camera: toRegisters(view, size), size, look: this.app.plainShading() };
      const made = await hand.call("run", job, ({ share }) => {
        $("hardware-progress").value = share;
      });
      this.#show(made, name);
    } catch (error) {
      const { message } = /** @type {Error} */ (error);
      const cancelled = message === "cancelled";
      this.#say(cancelled ? "" : message, !cancelled);
    }
    hand.stop();
    if (this.#hand !== hand) return;
    this.#hand = null;
    $("run-hardware").textContent = "Run the real hardware";
    $("hardware-progress").hidden = true;
  }

  /** @param {Compared} made @param {string} name */ #show({ colour, clocks, wordsRead, seconds, wrong }, name) {
    const pixels = WIDTH * HEIGHT;
    const verdict = wrong ? "the hardware and the model differ" : "the hardware and the model agree";
    this.#say(`${count(wrong)} wrong pixels of ${count(pixels)}: ${verdict}`, wrong > 0);
    const canvas = $("hardware-picture");
    Object.assign(canvas, { width: WIDTH, height: HEIGHT });
    const image = new ImageData(WIDTH, HEIGHT);
    for (let i = 0; i < pixels; i++) image.data.set([colour[3 * i], colour[3 * i + 1], colour[3 * i + 2], 255], 4 * i);
    canvas.getContext("2d", { alpha: false })?.putImageData(image, 0, 0);
    canvas.setAttribute("aria-label", `${name}, as the hardware shows it`);
    showFacts($("hardware-facts"), {
      clocks: count(clocks),
      "clocks per pixel": (clocks / pixels).toFixed(2),
      "words per pixel": (wordsRead / pixels).toFixed(2),
      "seconds here": seconds.toFixed(2),
    });
    $("hardware-result").hidden = false;
  }

  /** @param {string} text */ #say(text, bad = false) {
    $("hardware-says").textContent = text;
    $("hardware-says").classList.toggle("large", bad);
  }
}
