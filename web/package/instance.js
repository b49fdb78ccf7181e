// A module of voxrt in WebAssembly: its memory, its texts, and errors of one line.

/** An error of the input: one line, what is wrong and how to fix it. */
export class VoxrtError extends Error {
  name = "VoxrtError";
}

const EXHAUSTED = "takes more memory than a browser gives one page; choose a lesser depth";
const decoder = new TextDecoder();
const encoder = new TextEncoder();

/** The bytes of a text, as the modules take it. @param {string} text */
export const textBytes = (text) => encoder.encode(`${text}\0`);
/** @typedef {(...values: (number | boolean)[]) => number} Call */
/** @typedef {{ memory: WebAssembly.Memory, _initialize: Call } & { [name: `vx_${string}`]: Call }} Exports */
/** @typedef {BufferSource | Response | WebAssembly.Module} Source of a module: its bytes, or itself */

/** The array of a kind, of numbers in the memory of a module. @template T @typedef {{ BYTES_PER_ELEMENT: number, new
 * (buffer: ArrayBuffer, at: number, length: number): T }} Kind */

/** @typedef {{ readonly length: number, set(values: ArrayLike<number>): void }} NumberArray */

/** What Voxrt and Hardware have in common. Buffers move when the memory grows: views are made anew. */
export class Instance {
  /** @type {Exports} */ wasm;

  /** @param {Exports} wasm */ constructor(wasm) {
    this.wasm = wasm;
  }

  /** Compile and instantiate. @template {Instance} T @this {new (wasm: Exports) => T} @param {Source} source @param
   * {WebAssembly.Imports} [imports] what the module needs beside the system @returns {Promise<T>} */
  static async load(source, imports = {}) {
    const bytes = source instanceof Response ? await source.arrayBuffer() : source;
    const module = bytes instanceof WebAssembly.Module ? bytes : await WebAssembly.compile(bytes);
    /** @type {Exports | undefined} */ let wasm;
    const memory = () => /** @type {Exports} */ (wasm).memory.buffer;
    const { exports } = await WebAssembly.instantiate(module, { ...imports, wasi_snapshot_preview1: system(memory) });
    wasm = /** @type {Exports} */ (/** @type {unknown} */ (exports));
    wasm._initialize();
    return new this(wasm);
  }

  /** Bytes of memory in use. */
  get bytes() {
    return this.wasm.memory.buffer.byteLength;
  }

  /** @template T @param {Kind<T>} type @param {number} at @param {number} length @returns {T} */
  view(type, at, length) {
    return new type(this.wasm.memory.buffer, at, length);
  }

  /** @param {Kind<NumberArray>} type @param {ArrayLike<number>} values */ copy(type, values) {
    const at = this.wasm.vx_alloc(values.length * type.BYTES_PER_ELEMENT);
    if (!at) throw new VoxrtError(EXHAUSTED);
    this.view(type, at, values.length).set(values);
    return at;
  }

  /** Call with the addresses of copies of some numbers. @template T @param {Kind<NumberArray>[]} kinds of arrays
   * @param {ArrayLike<number>[]} arrays @param {(...at: number[]) => T} work */
  with(kinds, arrays, work) {
    /** @type {number[]} */ const copies = [];
    try {
      for (const [i, values] of arrays.entries()) copies.push(this.copy(kinds[i], values));
      return work(...copies);
    } finally {
      for (const at of copies) this.wasm.vx_free(at);
    }
  }

  /** @param {number} at */ string(at) {
    const bytes = new Uint8Array(this.wasm.memory.buffer, at);
    return decoder.decode(bytes.subarray(0, bytes.indexOf(0)).slice());
  }

  /** @param {number} result */ checked(result) {
    if (result < 0) throw new VoxrtError(this.string(this.wasm.vx_error()));
    return result;
  }

  /** Replace errors of the machine: out of memory, out of stack. @template T @param {() => T} work @returns {T} */
  guard(work) {
    try {
      return work();
    } catch (error) {
      if (error instanceof WebAssembly.RuntimeError || error instanceof RangeError) throw new VoxrtError(EXHAUSTED);
      throw error;
    }
  }
}

/** What the C library needs of the system: a clock, and nowhere to write. There are no files and no environment.
 * @param {() => ArrayBuffer} memory */
function system(memory) {
  const [done, noFile] = [0, 8]; // of WASI
  const none = () => noFile;
  return {
    fd_fdstat_get: none,
    fd_prestat_get: none,
    fd_prestat_dir_name: none,
    fd_read: none,
    environ_get: () => done,
    environ_sizes_get: (/** @type {number} */ count, /** @type {number} */ bytes) => {
      const view = new DataView(memory());
      view.setUint32(count, 0, true);
      view.setUint32(bytes, 0, true);
      return done;
    },
    proc_exit: () => {
      throw new WebAssembly.RuntimeError("the module has ended");
    },
    fd_write: (/** @type {number[]} */ ...[, parts, count, written]) => {
      const view = new DataView(memory());
      let bytes = 0;
      for (let i = 0; i < count; i++) bytes += view.getUint32(parts + 8 * i + 4, true);
      view.setUint32(written, bytes, true);
      return done;
    },
    fd_seek: () => done,
    fd_close: () => done,
    clock_time_get: (/** @type {number} */ _clock, /** @type {bigint} */ _precision, /** @type {number} */ at) => {
      new DataView(memory()).setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
      return done;
    },
  };
}
