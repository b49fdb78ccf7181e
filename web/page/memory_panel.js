// The panel of the memory: its depth, budget and light, what it takes, and the boards that hold it.

import { BoardPanel } from "./board_panel.js";
import { Budget } from "./budget.js";
import { Choices } from "./choices.js";
import { DaylightControl } from "./daylight.js";
import { $, all, element, pressed, showFacts } from "./elements.js";
import { Sharing } from "./sharing.js";
import { WarningList } from "./warning_list.js";
/** @import { App, Site } from "./app.js" @import { Shown } from "./memory.js" */
/** @import { Daylight } from "./voxrt/voxrt.js" */

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
    this.choices = new Choices(() => app.build());
    this.sharing = new Sharing(app);
    this.warnings = new WarningList(app);
    /** @type {ReturnType<typeof setTimeout> | undefined} */ let soon;
    $("depth").oninput = () => {
      this.#showDepth();
      clearTimeout(soon);
      soon = setTimeout(() => app.build(), SOON);
    };
  }

  /** How memories are built. */
  options() {
    const [depth, bake, budget] = [$("depth").valueAsNumber, this.daylight.options, this.budget.words];
    return { depth, bake, budget, ...this.choices.options };
  }

  /** @param {{ depth?: number | null, bake?: Daylight | null, words?: number | null } &
   * Partial<Choices["options"]>} options */
  set({ depth = null, bake = null, words = null, up = null, unit = null, fill = "auto", rule = "touch" }) {
    this.choices.options = { up, unit, fill, rule };
    if (depth !== null) $("depth").valueAsNumber = depth;
    if (bake) this.daylight.set(bake);
    this.budget.words = words;
    this.#showDepth();
  }

  #showDepth() {
    $("depth-value").textContent = `${count(2 ** $("depth").valueAsNumber)}³`;
  }

  /** @param {Shown} memory */ show(memory) {
    const { name, words, depth, voxels, fixed, seconds, fitted } = memory;
    const solid = voxels.reduce((sum, voxelCount, id) => (id ? sum + voxelCount : 0), 0);
    const time = seconds ? ` · ${seconds.toFixed(2)} s` : "";
    $("scene").textContent = name;
    $("details").textContent = `${count(2 ** depth)}³ voxels · ${count(words.length)} words${time}`;
    document.title = `${name} · voxrt`;
    for (const id of /** @type {const} */ (["depth", "bake", "budget", "budget-words"]))
      $(id).disabled = Boolean(fixed);
    if (fixed) $("depth").valueAsNumber = depth;
    this.#showDepth();
    this.choices.show(memory);
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
    this.warnings.show(memory);
    this.sharing.show(memory);
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
