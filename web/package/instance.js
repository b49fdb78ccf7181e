// A module of voxrt in WebAssembly: its memory, its texts, and errors of one line.

export class VoxrtError extends Error {
  name = "VoxrtError";
}

const EXHAUSTED = "takes more memory than a browser gives one page; choose a lesser depth";
const decoder = new TextDecoder();
const encoder = new TextEncoder();

// What Voxrt and Hardware have in common. Buffers of a module move when its memory grows: views are made anew each time.
export class Instance {
  // Compile and instantiate. `source`: the bytes of the module, a Response with them, or a WebAssembly.Module.
  // `imports`: what the module needs beside the system.
  static async load(source, imports = {}) {
    const made = new this();
    const bytes = typeof Response !== "undefined" && source instanceof Response ? await source.arrayBuffer() : source;
    const module = bytes instanceof WebAssembly.Module ? bytes : await WebAssembly.compile(bytes);
    made.wasm = (await WebAssembly.instantiate(module, { ...imports, wasi_snapshot_preview1: system(made) })).exports;
    made.wasm._initialize();
    return made;
  }

  // Bytes of memory in use.
  get bytes() {
    return this.wasm.memory.buffer.byteLength;
  }

  view(type, at, length) {
    return new type(this.wasm.memory.buffer, at, length);
  }

  copy(type, values) {
    const at = this.wasm.vx_alloc(values.length * type.BYTES_PER_ELEMENT);
    if (!at) throw new VoxrtError(EXHAUSTED);
    this.view(type, at, values.length).set(values);
    return at;
  }

  with(type, values, work) {
    const at = this.copy(type, values);
    try {
      return work(at);
    } finally {
      this.wasm.vx_free(at);
    }
  }

  text(text, work) {
    return this.with(Uint8Array, encoder.encode(`${text}\0`), work);
  }

  string(at) {
    const bytes = new Uint8Array(this.wasm.memory.buffer, at);
    return decoder.decode(bytes.subarray(0, bytes.indexOf(0)).slice());
  }

  checked(result) {
    if (result < 0) throw new VoxrtError(this.string(this.wasm.vx_error()));
    return result;
  }

  // What the machine throws instead of the library: out of memory, out of stack.
  guard(work) {
    try {
      return work();
    } catch (error) {
      if (error instanceof WebAssembly.RuntimeError || error instanceof RangeError) throw new VoxrtError(EXHAUSTED);
      throw error;
    }
  }
}

// What the C library asks of the system: a clock, and nowhere to write. There are no files and no environment.
function system(instance) {
  const [done, noFile] = [0, 8]; // of WASI
  const none = () => noFile;
  return {
    fd_fdstat_get: none,
    fd_prestat_get: none,
    fd_prestat_dir_name: none,
    fd_read: none,
    environ_get: () => done,
    environ_sizes_get: (count, bytes) => {
      const view = new DataView(instance.wasm.memory.buffer);
      view.setUint32(count, 0, true);
      view.setUint32(bytes, 0, true);
      return done;
    },
    proc_exit: () => {
      throw new WebAssembly.RuntimeError("the module has ended");
    },
    fd_write: (_file, parts, count, written) => {
      const view = new DataView(instance.wasm.memory.buffer);
      let bytes = 0;
      for (let i = 0; i < count; i++) bytes += view.getUint32(parts + 8 * i + 4, true);
      view.setUint32(written, bytes, true);
      return done;
    },
    fd_seek: () => done,
    fd_close: () => done,
    clock_time_get: (_clock, _precision, at) => {
      new DataView(instance.wasm.memory.buffer).setBigUint64(at, BigInt(Math.round(performance.now() * 1e6)), true);
      return done;
    },
  };
}
