// The budget of words: a slider, which counts in powers, a field for the number, and the boards.

import { $ } from "./elements.js";

const LEAST = 73; // words of the slider's lower end
const STEPS = 100; // the last one is no budget
const SOON = 300; // milliseconds

export class Budget {
  /** @type {number | null} */ words = null;
  #whole = LEAST + 1;
  /** @type {ReturnType<typeof setTimeout> | undefined} */ #soon;

  /** @param {() => void} onChange called when a new memory has to be built */ constructor(onChange) {
    this.onChange = onChange;
    $("budget").oninput = () => {
      const step = $("budget").valueAsNumber;
      this.choose(step >= STEPS ? null : Math.round(LEAST * (this.#whole / LEAST) ** (step / STEPS)));
    };
    $("budget-words").onchange = () => {
      const { value, validity, valueAsNumber } = $("budget-words");
      if (value === "") this.choose(null);
      else if (validity.valid) this.choose(valueAsNumber);
    };
  }

  /** @param {number | null} words */ choose(words) {
    clearTimeout(this.#soon);
    this.words = words;
    this.#show();
    this.#soon = setTimeout(this.onChange, SOON);
  }

  /** Show the budget after a build. @param {number} whole what the memory takes without a budget */
  fits(whole) {
    this.#whole = Math.max(whole, LEAST + 1);
    this.#show();
  }

  #show() {
    const { words } = this;
    const part = words === null ? 1 : Math.log(words / LEAST) / Math.log(this.#whole / LEAST);
    $("budget").valueAsNumber = words === null ? STEPS : Math.min(STEPS - 1, Math.round(STEPS * part));
    const text = words === null ? "no budget" : `${words.toLocaleString("en")} words`;
    $("budget").setAttribute("aria-valuetext", text);
    $("budget-words").value = words === null ? "" : String(words);
  }
}
