// The choices of how a model is read and filled: its up axis, its unit, its fill.

import { $ } from "./elements.js";
import { extension } from "./folder.js";
import { UPWARDS } from "./placing.js";
/** @import { Memory } from "./memory.js" @import { Placing } from "./placing.js" */
/** @import { Fill, Rule } from "./voxrt/voxrt.js" */

const STATED = "The format of this file states it";

export class Choices {
  /** @type {Placing & { fill: Fill, rule: Rule }} */
  options = { up: null, unit: null, fill: "auto", rule: "touch" };

  /** @param {() => void} onChange called when a new memory has to be built */ constructor(onChange) {
    $("up").onchange = () => this.choose({ up: $("up").value }, onChange);
    $("unit").onchange = () => this.choose({ unit: Number($("unit").value) }, onChange);
    $("fill").onchange = () => this.choose({ fill: /** @type {Fill} */ ($("fill").value) }, onChange);
    $("rule").onchange = () => this.choose({ rule: /** @type {Rule} */ ($("rule").value) }, onChange);
  }

  /** @param {Partial<Choices["options"]>} some @param {() => void} onChange */ choose(some, onChange) {
    this.options = { ...this.options, ...some };
    onChange();
  }

  /** @param {Memory} memory */ show({ file, fixed }) {
    const { up, unit, fill, rule } = this.options;
    const upwards = UPWARDS[extension(file)];
    for (const name of /** @type {const} */ (["up", "unit"])) {
      $(name).disabled = !upwards;
      $(name).title = upwards ? "" : STATED;
    }
    $("up").value = (upwards && up) || upwards || "y";
    $("unit").value = String((upwards && unit) || 1);
    $("fill").value = fill;
    $("rule").value = rule;
    $("fill").disabled = $("rule").disabled = Boolean(fixed);
  }
}
