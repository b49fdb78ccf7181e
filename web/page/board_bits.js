// The bitstream of a board that shows a memory from power-on, turning: a placed design as ecppack packs it, with other
// contents of its block RAMs. The board's file (web/board_files.py) says where they are.

const [HEAD, DATA] = [12, 2304]; // bytes of a command before its data, and of its data

/** @import { Memory } from "./memory.js" @import { Hardware } from "./voxrt/hardware.js" */
/** @import { Look, Size, Voxrt } from "./voxrt/voxrt.js" */

/** Part of a memory in a block RAM: `at` is its command in the bitstream; rows from `row` on; bits from `bit` on,
 * `bits` of them; `places` of words in a group. @typedef {{ at: number, row: number, rows: number, bit: number,
 * bits: number, places: number[] }} BlockRam */

/** `capacity`: words; `depth`: levels. @typedef {{ name: string, hardware: string, loader: string, capacity: number,
 * depth: number, clock: number, bufferLines: number, blockBits: number, screen: Size, orbit: { cameras: number, at:
 * number, step: number, list: number[], places: number[], bits: number[] }, boot: { words: number, depth: number,
 * root: number, materials: number, lists: Record<string, number[][]> }, octree: BlockRam[], table: BlockRam[] }}
 * Board */

/** @typedef {Pick<Memory, "words" | "depth" | "materials">} Content */

/** The cameras of an orbit: 12 registers each. @param {Voxrt} voxrt @param {number} count @param {Size} size */
function orbitOf(voxrt, count, [width, height]) {
  voxrt.guard(() => voxrt.checked(voxrt.wasm.vx_orbit(count, width, height)));
  return voxrt.view(Int32Array, voxrt.wasm.vx_registers(), 12 * count).slice();
}

/** The largest pictures of voxrt's memory that a board traces in time. @param {Voxrt} voxrt @param {Hardware}
 * hardware the board's ray tracer, with the same memory @param {Board} board @param {Look} look @param {(done:
 * number, total: number) => void} [onProgress] called with the pictures that are done, of how many */
export function fitBeam(voxrt, hardware, board, look, onProgress = () => {}) {
  const { wasm } = voxrt;
  voxrt.guard(() => voxrt.checked(wasm.vx_beam(board.orbit.cameras, board.clock, board.bufferLines)));
  for (;;) {
    const size = voxrt.checked(wasm.vx_beam_band());
    const figures = voxrt.view(Float64Array, wasm.vx_beam_figures(), 6);
    const [scale, cyclesPerPixel, lead, framesPerSecond, done, total] = figures;
    onProgress(done, total);
    if (!size) return { scale, cyclesPerPixel, lead, framesPerSecond };
    const registers = [...voxrt.view(Int32Array, wasm.vx_registers(), 12)];
    const [position, ahead, right, up] = [0, 3, 6, 9].map((at) => registers.slice(at, at + 3));
    const { clocks } = hardware.render({ position, look: ahead, right, up }, [size >> 16, size & 0xffff], look);
    voxrt.checked(wasm.vx_beam_give(clocks));
  }
}

/** The bytes of the bitstream. @param {Voxrt} voxrt @param {Uint8Array} bits those of the placed design @param
 * {Board} board @param {Content} memory what voxrt holds @param {{ flat?: boolean, scale: number }} options */
export function bitstreamOf(voxrt, bits, board, memory, { flat = false, scale }) {
  const made = bits.slice();
  const { wasm } = voxrt;
  const count = voxrt.guard(() => voxrt.checked(wasm.vx_encode(board.blockBits)));
  replace(made, board.octree, voxrt.view(Uint32Array, wasm.vx_encoded_rows(), count).slice());
  replace(made, board.table, tableOf(voxrt, board, memory, flat, scale));
  return made;
}

/** The table that the board starts from: its list, and an orbit. @param {Voxrt} voxrt @param {Board} board @param
 * {Content} memory @param {boolean} flat @param {number} scale */
function tableOf(voxrt, { boot, orbit, screen }, { words, depth, materials }, flat, scale) {
  const table = new Uint32Array(boot.words);
  table.set(boot.lists[flat ? "flat" : "faces"][scale]);
  table[boot.depth] = depth;
  table[boot.root] = words[0];
  materials.forEach(({ colour: [red, green, blue], mirror }, id) => {
    table[boot.materials + id] = (Number(mirror) << 24) | (red << 16) | (green << 8) | blue;
  });
  const size = screen.map((side) => side >> scale);
  const cameras = orbitOf(voxrt, orbit.cameras, size);
  for (let step = 0; step < orbit.cameras; step++) {
    const at = orbit.at + orbit.step * step;
    table.set(orbit.list, at);
    orbit.places.forEach((place, i) => {
      table[at + place] = cameras[12 * step + i] & (2 ** orbit.bits[i] - 1);
    });
  }
  return table;
}

/** Replace what block RAMs hold by the rows of a memory, those beyond them by 0. @param {Uint8Array} bits @param
 * {BlockRam[]} blockRams @param {Uint32Array} memory */
function replace(bits, blockRams, memory) {
  for (const { at, row, rows, bit, bits: width, places } of blockRams) {
    const data = bits.subarray(at + HEAD, at + HEAD + DATA);
    data.fill(0);
    const group = places.length === 1 ? 18 * Math.ceil(width / 18) : 18; // bits from one group of words to the next
    for (let i = 0; i < rows; i++) {
      const value = memory[row + i] ?? 0;
      const first = group * Math.floor(i / places.length) + places[i % places.length];
      for (let j = 0; j < width && bit + j < 32; j++) {
        if (!((value >>> (bit + j)) & 1)) continue;
        const to = first + j; // values of 9 bits, the highest first
        const place = 9 * Math.floor(to / 9) + 8 - (to % 9);
        data[place >> 3] |= 0x80 >> (place & 7);
      }
    }
    const end = at + HEAD + DATA;
    const sum = checksum(bits.subarray(at, end));
    bits[end] = sum >> 8;
    bits[end + 1] = sum & 255;
  }
}

/** The CRC that ECP5 keeps of commands: x^16 + x^15 + x^2 + 1, the highest bit first. @param {Uint8Array} bytes */
function checksum(bytes) {
  let sum = 0;
  /** @param {number} byte */ const add = (byte) => {
    for (let bit = 7; bit >= 0; bit--)
      sum = (((sum << 1) & 0xffff) | ((byte >> bit) & 1)) ^ (sum & 0x8000 ? 0x8005 : 0);
  };
  for (const byte of bytes) add(byte);
  add(0);
  add(0);
  return sum;
}
