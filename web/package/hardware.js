// The ray tracer's RTL in WebAssembly: the configuration `tiny`, verilated, with a memory of its own. It has faces, flat
// and angle shading, and no light or mirrors.
//
//     const hardware = await Hardware.start(await fetch("voxrt_hardware.wasm"));
//     hardware.setMemory(built.words, built.depth);
//     const { colour, clocks } = hardware.render(camera, [320, 240], { materials });

import { Instance, VoxrtError } from "./instance.js";
import { FACES } from "./voxrt.js";

export class Hardware extends Instance {
  // Compile and reset. `source`: as for Voxrt.load. `onProgress` is called with the pixels that are ready, now and then
  // within a frame.
  static async start(source, onProgress = () => {}) {
    return Hardware.load(source, { page: { progress: onProgress } });
  }

  // How many words its memory holds.
  get wordLimit() {
    return this.wasm.vx_word_limit();
  }

  setMemory(words, depth) {
    if (words.length > this.wordLimit)
      throw new VoxrtError(`the hardware's memory holds ${this.wordLimit} words, not ${words.length}`);
    this.depth = depth;
    this.guard(() => this.with(Uint32Array, words, (at) => this.checked(this.wasm.vx_load(at, words.length))));
  }

  // Render a frame. camera: {position in 1/16 voxel, look, right, up}. materials: sRGB triples by id, entry 0 the
  // background. faces: six brightnesses, or null for the angle. Returns copies: colour (RGB), material and face; clocks
  // from the start to the last pixel, and wordsRead.
  render(camera, [width, height], { materials, flat = false, faces = FACES }) {
    const table = new Uint8Array(768);
    materials.forEach((colour, id) => table.set(colour, 3 * id));
    const registers = [...camera.position, ...camera.look, ...camera.right, ...camera.up];
    return this.guard(() => {
      const clocks = this.with(Int32Array, registers, (at) =>
        this.with(Uint8Array, table, (colours) =>
          this.with(Uint8Array, faces ?? [], (brightness) =>
            this.checked(
              this.wasm.vx_run(at, width, height, this.depth, colours, flat, faces && !flat ? brightness : 0),
            ),
          ),
        ),
      );
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
