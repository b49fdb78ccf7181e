// The panel of the memory: its depth, budget and light, what it takes, and the boards that hold it.

import { BoardPanel } from "./board_panel.js";
import { Budget } from "./budget.js";
import { DaylightControl } from "./daylight.js";
import { $, all, element, pressed, showFacts } from "./elements.js";
/** @import { App, Site } from "./app.js" @import { Shown } from "./memory.js" */

const SOON = 150; // milliseconds after the last change of the slider
const KIB = 256; // words
const MIB = 1024 * KIB;
const short = new Intl.NumberFormat("en", { notation: "compact", maximumSignificantDigits: 3 });
/** @param {number} number */ const count = (number) => number.toLocaleString("en");

/** @param {number} words */ function size(words) {
  const [unit, name] = words < MIB ? [KIB, "KiB"] : [MIB, "MiB"];
  return `${(words / unit).toLocaleString("en", { maximumFractionDigits: 1 })} ${name}`;
}

export class MemoryPanel {
  /** @param {App} app @param {WebAssembly.Module} module voxrt.wasm @param {Site} site */
  constructor(app, module, site) {
    this.app = app;
    this.site = site;
    this.bitstreams = new BoardPanel(app, module);
    this.daylight = new DaylightControl(() => app.build());
    this.budget = new Budget(() => app.build());
    /** @type {ReturnType<typeof setTimeout> | undefined} */ let soon;
    $("depth").oninput = () => {
      this.#showDepth();
      clearTimeout(soon);
      soon = setTimeout(() => app.build(), SOON);
    };
  }

  /** How memories are built. */
  options() {
    const fill = /** @type {const} */ ("auto");
    return { depth: $("depth").valueAsNumber, fill, bake: this.daylight.options, budget: this.budget.words };
  }

  /** @param {{ depth?: number | null, bake?: ReturnType<MemoryPanel["options"]>["bake"], words?: number | null }}
   * options */
  set({ depth = null, bake = null, words = null }) {
    if (depth !== null) $("depth").valueAsNumber = depth;
    if (bake) this.daylight.set(bake);
    this.budget.words = words;
    this.#showDepth();
  }

  #showDepth() {
    $("depth-value").textContent = `${count(2 ** $("depth").valueAsNumber)}³`;
  }

  /** @param {Shown} memory */ show(memory) {
    const { name, words, depth, voxels, warnings, fixed, seconds, fitted } = memory;
    const solid = voxels.reduce((sum, voxelCount, id) => (id ? sum + voxelCount : 0), 0);
    const time = seconds ? ` · ${seconds.toFixed(2)} s` : "";
    $("scene").textContent = name;
    $("details").textContent = `${count(2 ** depth)}³ voxels · ${count(words.length)} words${time}`;
    document.title = `${name} · voxrt`;
    for (const id of /** @type {const} */ (["depth", "bake", "budget", "budget-words"]))
      $(id).disabled = Boolean(fixed);
    if (fixed) $("depth").valueAsNumber = depth;
    this.#showDepth();
    this.budget.fits(fitted?.wordsShared ?? words.length);
    const changed = fitted ? (100 * fitted.changed) / (fitted.surface || 1) : 0;
    showFacts($("facts"), {
      words: count(words.length),
      memory: size(words.length),
      "solid voxels": short.format(solid),
      ...(fitted && { "without budget": count(fitted.wordsShared), "surface changed": `${changed.toFixed(1)} %` }),
    });
    const boards = Object.entries(this.site.boards);
    $("boards").replaceChildren(...boards.map(([board, limit]) => this.#board(board, limit, memory)));
    const texts = warnings.map(({ message, count: times }) => (times > 1 ? `${message} (${times})` : message));
    $("warnings").replaceChildren(...texts.map((text) => element("li", {}, text)));
    for (const chip of all("button", $("examples"))) pressed(chip, chip.dataset.example === this.app.source?.example);
  }

  /** The row of a board. @param {string} board @param {number} limit @param {Shown} memory */
  #board(board, limit, { words, fixed }) {
    const fits = words.length <= limit;
    const share = words.length / limit;
    const label = { "aria-label": `Memory of ${board} in use` };
    const meter = element("meter", { min: 0, max: 1, high: 0.999, optimum: 0, value: Math.min(1, share), ...label });
    const verdict = fits ? "fits" : `${share.toFixed(1)} × too large`;
    let last = element("span", { className: fits ? "fits" : "large" }, verdict);
    if (fits && this.site.designs.includes(board)) last = this.bitstreams.button(board);
    else if (!fits && !fixed) {
      const title = `${verdict}: give up what is seen least`;
      const onclick = () => this.budget.choose(limit);
      last = element("button", { type: "button", title, onclick, "aria-label": `Fit to ${board}` }, "Fit");
    }
    return element("li", {}, element("span", {}, board), meter, last);
  }
}
