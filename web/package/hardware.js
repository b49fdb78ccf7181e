// The ray tracer's RTL in WebAssembly: the configuration `tiny`, verilated, with a memory of its own. It has faces, flat
// and angle shading, and no light or mirrors.
//
//     const hardware = await Hardware.start(await fetch("voxrt_hardware.wasm"));
//     hardware.setMemory(built.words, built.depth);
//     const { colour, clocks } = hardware.render(camera, [320, 240], { materials });

import { Instance, VoxrtError } from "./instance.js";
import { colourTable, FACES } from "./voxrt.js";
/** @import { Source } from "./instance.js" @import { Camera, Look, Size } from "./voxrt.js" */

/** @typedef {{ colour: Uint8Array, material: Uint8Array, face: Uint8Array, clocks: number, wordsRead: number }}
 * Rendered */

/** The verilated ray tracer. */
export class Hardware extends Instance {
  #depth = 1;

  /** Compile and reset. @param {Source} source voxrt_hardware.wasm @param {(pixels: number) => void} [onProgress]
   * called now and then within a frame, with the pixels that are ready */
  static async start(source, onProgress = () => {}) {
    return Hardware.load(source, { page: { progress: onProgress } });
  }

  /** How many words its memory holds. */
  get wordLimit() {
    return this.wasm.vx_word_limit();
  }

  /** @param {ArrayLike<number>} words @param {number} depth */ setMemory(words, depth) {
    if (words.length > this.wordLimit)
      throw new VoxrtError(`the hardware's memory holds ${this.wordLimit} words, not ${words.length}`);
    this.#depth = depth;
    this.guard(() => this.with([Uint32Array], [words], (at) => this.checked(this.wasm.vx_load(at, words.length))));
  }

  /** Render a frame as its pixels leave the circuit. Returns copies. @param {Camera} camera @param {Size} size
   * @param {Pick<Look, "materials" | "flat" | "faces">} look @returns {Rendered} */
  render({ position, look, right, up }, [width, height], { materials, flat = false, faces = FACES }) {
    const arrays = [[...position, ...look, ...right, ...up], colourTable(materials), faces ?? []];
    return this.guard(() => {
      const clocks = this.with([Int32Array, Uint8Array, Uint8Array], arrays, (at, colours, brightness) => {
        const lit = faces && !flat ? brightness : 0;
        return this.checked(this.wasm.vx_run(at, width, height, this.#depth, colours, flat, lit));
      });
      return {
        clocks,
        wordsRead: this.wasm.vx_words_read(),
        colour: this.view(Uint8Array, this.wasm.vx_colour(), 3 * width * height).slice(),
        material: this.view(Uint8Array, this.wasm.vx_frame_material(), width * height).slice(),
        face: this.view(Uint8Array, this.wasm.vx_frame_face(), width * height).slice(),
      };
    });
  }
}
