// The budget of words: a slider, which counts in powers, a field for the number, and the boards.

import { $ } from "./elements.js";

const LEAST = 73; // words of the slider's lower end
const STEPS = 100; // the last one is no budget

export class Budget {
  // `onChange` is called when a new memory has to be built.
  constructor(onChange) {
    Object.assign(this, { words: null, whole: LEAST + 1 });
    let soon = null;
    const choose = (words) => {
      clearTimeout(soon);
      this.words = words;
      this.show();
      soon = setTimeout(onChange, 300);
    };
    this.choose = choose;
    $("budget").oninput = ({ target }) =>
      choose(
        target.valueAsNumber >= STEPS
          ? null
          : Math.round(LEAST * (this.whole / LEAST) ** (target.valueAsNumber / STEPS)),
      );
    $("budget-words").onchange = ({ target }) => {
      if (target.value === "") choose(null);
      else if (target.validity.valid) choose(target.valueAsNumber);
    };
  }

  // After a build: `whole` is what the memory takes without a budget.
  fits(whole) {
    this.whole = Math.max(whole, LEAST + 1);
    this.show();
  }

  show() {
    const part = this.words === null ? 1 : Math.log(this.words / LEAST) / Math.log(this.whole / LEAST);
    $("budget").value = this.words === null ? STEPS : Math.min(STEPS - 1, Math.round(STEPS * part));
    $("budget").setAttribute(
      "aria-valuetext",
      this.words === null ? "no budget" : `${this.words.toLocaleString("en")} words`,
    );
    $("budget-words").value = this.words ?? "";
  }
}
