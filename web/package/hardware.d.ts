import type { Camera, Triple } from "./voxrt.js";

/** The verilated ray tracer, configuration `tiny`. */
export class Hardware {
  /** `source`: voxrt_hardware.wasm as bytes, as a Response or as a module. */
  static start(source: BufferSource | Response | WebAssembly.Module, onProgress?: (pixels: number) => void): Promise<Hardware>;
  /** How many words its memory holds. */
  readonly wordLimit: number;
  setMemory(words: ArrayLike<number>, depth: number): void;
  /** Render a frame as its pixels leave the circuit. `materials`: sRGB by id; entry 0 is the background. */
  render(
    camera: Camera,
    size: readonly [number, number],
    look: { materials: ArrayLike<number>[] | Triple[]; flat?: boolean; faces?: ArrayLike<number> | null },
  ): { colour: Uint8Array; material: Uint8Array; face: Uint8Array; clocks: number; wordsRead: number };
}
