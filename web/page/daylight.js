// Baked light: the switch, and the sun and the sky. Their defaults are those of voxrt build.

import { $, isPressed, pressed } from "./elements.js";
import { DAYLIGHT } from "./voxrt/voxrt.js";

const FIELDS = ["sun-x", "sun-y", "sun-z", "sky", "samples"];

// `onChange` is called when a new memory has to be built.
export class DaylightControl {
  constructor(onChange) {
    this.set(null);
    let soon = null;
    for (const field of FIELDS)
      $(field).oninput = () => {
        clearTimeout(soon);
        if (this.on && FIELDS.every((one) => $(one).validity.valid)) soon = setTimeout(onChange, 300);
      };
    $("bake").onclick = () => {
      this.show(!this.on);
      onChange();
    };
  }

  get on() {
    return isPressed($("bake"));
  }

  // As of Voxrt.voxelize.
  get options() {
    if (!this.on) return null;
    const [x, y, z, sky, samples] = FIELDS.map((field) => $(field).valueAsNumber);
    return { sun: [x, y, z], sky: [sky, sky, sky], samples };
  }

  set(options) {
    const { sun, sky, samples } = options ?? DAYLIGHT;
    [...sun, sky[0], samples].forEach((value, i) => {
      $(FIELDS[i]).value = value;
    });
    this.show(options !== null);
  }

  show(on) {
    pressed($("bake"), on);
    $("daylight").hidden = !on;
  }
}
