// The size of frames: as fine as the stage at rest, coarser while the camera moves, and fine again in steps where the
// device is slow. All sizes have the shape of the stage.

/** @import { Size } from "./camera.js" @import { Wanted } from "./frame_requests.js" */
/** @import { Device } from "./protocol.js" */

const MOVING = 0.05; // seconds that a frame may take while the camera moves
const STEP = 1; // seconds: a finer frame that takes longer than this comes after one of half its columns
const LONGEST = 60; // seconds that a frame may take at all
const SMOOTH = 0.5; // seconds that a frame with four rays per pixel may take, where the device names no others
const COARSEST = 8; // part of the columns and rows
const PIXELS = 1 << 22; // of a frame, where the device names no other number
const RATIO = 2; // of the screen's pixels to those of the page, at most

export class Resolution {
  /** @type {number | null} seconds per pixel */ cost = null;
  #newest = 0; // seconds per pixel of the newest frame: the first frames of a scene are slow
  /** @type {Size | null} a size that was chosen in place of the stage's */ fixed = null;

  /** Learn from a frame; what the network takes counts too. @param {Size} size @param {number} seconds */
  measure([width, height], seconds) {
    const cost = seconds / (width * height);
    this.#newest = cost;
    this.cost = this.cost === null ? cost : Math.sqrt(this.cost * cost);
  }

  /** @param {Size} size */ seconds = ([width, height]) => (this.cost === null ? 0 : this.cost * width * height);

  /** The frame of the stage at rest; 2 samples double columns and rows. @param {HTMLElement} stage @param {Device}
   * device */
  finest(stage, device) {
    const ratio = Math.min(devicePixelRatio, RATIO);
    const wanted = this.fixed ?? [stage.clientWidth * ratio, stage.clientHeight * ratio];
    const size = fitting(wanted, 1, device);
    const doubled = size.map((side) => 2 * side);
    const smooth =
      !this.fixed &&
      this.cost !== null &&
      Math.min(this.cost, this.#newest) * doubled[0] * doubled[1] <= (device.smooth ?? SMOOTH) &&
      doubled[0] * doubled[1] <= (device.pixels ?? PIXELS) &&
      doubled.every((side, i) => side <= device.size[i]) &&
      doubled[0] % device.width_step === 0;
    return { size, samples: smooth ? 2 : 1 };
  }

  /** The frame while the camera moves. @param {HTMLElement} stage @param {Device} device */
  moving(stage, device) {
    const { size } = this.finest(stage, device);
    if (this.cost === null) return { size: fitting(size, COARSEST, device), samples: 1 };
    const part = Math.min(COARSEST, Math.max(1, Math.sqrt(this.seconds(size) / MOVING)));
    return { size: fitting(size, Math.ceil(part * 2) / 2, device), samples: 1 };
  }

  /** The frame after one of `shown` columns and rows when the camera has come to rest. @param {HTMLElement} stage
   * @param {Device} device @param {Size} shown */
  next(stage, device, shown) {
    const { size, samples } = this.finest(stage, device);
    if (samples > 1) return { size, samples };
    for (const part of [1, 2, 4, COARSEST]) {
      const some = fitting(size, part, device);
      const seconds = this.seconds(some);
      if (seconds > LONGEST) continue;
      if (seconds <= STEP || 2.1 * shown[0] >= some[0]) return { size: some, samples: 1 };
    }
    return { size: shown, samples: 1 };
  }
}

/** A part of a size that the device can render. @param {Size} size @param {number} part @param {Device} device */
function fitting([width, height], part, device) {
  const [widest, highest] = device.size;
  const factor = Math.min(1 / part, widest / width, highest / height, Math.sqrt(PIXELS / (width * height)));
  const step = device.width_step;
  const columns = Math.max(step, Math.floor((width * factor) / step) * step);
  return [columns, Math.max(1, Math.round((height * columns) / width))];
}
