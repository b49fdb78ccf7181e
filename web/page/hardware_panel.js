// "Run the real hardware": the verilated ray tracer renders the view once, clock by clock, and the page holds its
// picture against the model's.

import { toRegisters } from "./camera.js";
import { $ } from "./elements.js";
import { Hand } from "./hand.js";

const SIZE = [320, 240];
const count = (number) => number.toLocaleString("en");

export class HardwarePanel {
  // `app`: as of main.js. `module`: voxrt.wasm, compiled.
  constructor(app, module) {
    Object.assign(this, { app, module, hand: null });
    $("run-hardware").onclick = () => (this.hand ? this.stop() : this.run());
  }

  async run() {
    const memory = this.app.memory();
    if (!memory) return;
    const hand = new Hand("./hardware_worker.js");
    this.hand = hand;
    $("run-hardware").textContent = "Cancel";
    $("hardware-progress").hidden = false;
    $("hardware-progress").removeAttribute("value");
    this.say("Loading the hardware …");
    try {
      await hand.start(this.module);
      this.say("Running …");
      const job = {
        words: memory.words,
        depth: memory.depth,
        camera: toRegisters(this.app.view(), SIZE),
        size: SIZE,
        look: this.app.plainLook(),
      };
      this.show(
        await hand.call("run", job, ({ share }) => {
          $("hardware-progress").value = share;
        }),
        memory.name,
      );
    } catch (error) {
      this.say(error.message === "cancelled" ? "" : error.message, error.message !== "cancelled");
    }
    hand.stop();
    if (this.hand !== hand) return;
    this.hand = null;
    $("run-hardware").textContent = "Run the real hardware";
    $("hardware-progress").hidden = true;
  }

  stop() {
    this.hand.stop();
  }

  show({ colour, clocks, wordsRead, seconds, wrong }, name) {
    const pixels = SIZE[0] * SIZE[1];
    this.say(
      `${count(wrong)} wrong pixels of ${count(pixels)}: ${wrong ? "the hardware and the model differ" : "the hardware and the model agree"}`,
      wrong > 0,
    );
    const canvas = $("hardware-picture");
    [canvas.width, canvas.height] = SIZE;
    const context = canvas.getContext("2d", { alpha: false });
    const image = context.createImageData(...SIZE);
    for (let i = 0; i < pixels; i++) image.data.set([colour[3 * i], colour[3 * i + 1], colour[3 * i + 2], 255], 4 * i);
    context.putImageData(image, 0, 0);
    canvas.setAttribute("aria-label", `${name}, as the hardware shows it`);
    const facts = {
      clocks: count(clocks),
      "clocks per pixel": (clocks / pixels).toFixed(2),
      "words per pixel": (wordsRead / pixels).toFixed(2),
      "seconds here": seconds.toFixed(2),
    };
    $("hardware-facts").replaceChildren(
      ...Object.entries(facts).map(([term, value]) => {
        const box = document.createElement("div");
        box.append(
          Object.assign(document.createElement("dt"), { textContent: term }),
          Object.assign(document.createElement("dd"), { textContent: value }),
        );
        return box;
      }),
    );
    $("hardware-result").hidden = false;
  }

  say(text, bad = false) {
    $("hardware-says").textContent = text;
    $("hardware-says").classList.toggle("large", bad);
  }
}
