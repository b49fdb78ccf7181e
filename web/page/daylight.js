// Baked light: the switch, and the sun and the sky. Their defaults are those of voxrt build.

import { $, isPressed, pressed } from "./elements.js";
import { DAYLIGHT } from "./voxrt/voxrt.js";
/** @import { Daylight } from "./voxrt/voxrt.js" */

const FIELDS = /** @type {const} */ (["sun-x", "sun-y", "sun-z", "sky", "samples"]);
const SOON = 300; // milliseconds

export class DaylightControl {
  /** @param {() => void} onChange called when a new memory has to be built */ constructor(onChange) {
    this.set(null);
    /** @type {ReturnType<typeof setTimeout> | undefined} */ let soon;
    for (const field of FIELDS)
      $(field).oninput = () => {
        clearTimeout(soon);
        if (this.on && FIELDS.every((one) => $(one).validity.valid)) soon = setTimeout(onChange, SOON);
      };
    $("bake").onclick = () => {
      this.#show(!this.on);
      onChange();
    };
  }

  get on() {
    return isPressed($("bake"));
  }

  get options() {
    if (!this.on) return null;
    const [x, y, z, sky, samples] = FIELDS.map((field) => $(field).valueAsNumber);
    return { sun: [x, y, z], sky: [sky, sky, sky], samples };
  }

  /** @param {Daylight | null} options */ set(options) {
    const { sun, sky, samples } = options ?? DAYLIGHT;
    const values = [...sun, sky[0], samples];
    for (const [i, field] of FIELDS.entries()) $(field).value = String(values[i]);
    this.#show(options !== null);
  }

  /** @param {boolean} on */ #show(on) {
    pressed($("bake"), on);
    $("daylight").hidden = !on;
  }
}
