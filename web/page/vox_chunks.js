// The chunks of MagicaVoxel files.

export const DAMAGED = "the file is damaged; save it again";
/** @typedef {{ size: number[], voxels: Uint8Array }} Model `voxels`: x, y, z and colour of each */

/** A node of the scene graph: a transform with its child, a group with its children, or a shape with its models.
 * @typedef {{ child: number, rows: number[][], offset: number[], hidden: boolean, layer: number, frames: number } |
 * { children: number[] } | { models: number[] }} VoxNode */

/** `hidden`: layers; `kinds`: of materials that are not diffuse, by colour; `palette`: sRGB. @typedef {{ models:
 * Model[], nodes: Map<number, VoxNode>, hidden: Set<number>, kinds: Map<number, string>, palette: (colour: number)
 * => number[] }} VoxFile */

/** A part of the file, read from its start to its end. */
class Reader {
  /** @param {string} name @param {Uint8Array} bytes @param {number} at @param {number} end @param {string} kind */
  constructor(name, bytes, at, end, kind) {
    this.name = name;
    this.bytes = bytes;
    this.at = at;
    this.end = end;
    this.place = `chunk ${kind} at byte ${at}`;
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }
  /** @param {string} problem */ fault = (problem) => new Error(`${this.name}: ${this.place}: ${problem}; ${DAMAGED}`);
  /** @param {number} count */ take(count) {
    if (count < 0 || count > this.end - this.at)
      throw this.fault(`${count} bytes should follow, and ${this.end - this.at} do`);
    this.at += count;
    return this.bytes.subarray(this.at - count, this.at);
  }
  integer() {
    this.take(4);
    return this.view.getInt32(this.at - 4, true);
  }
  /** @param {number} size bytes per entry */ count(size) {
    const count = this.integer();
    if (count < 0 || count > Math.floor((this.end - this.at) / size))
      throw this.fault(`${count} entries should follow, and the chunk is too short for them`);
    return count;
  }
  text = () => new TextDecoder().decode(this.take(this.count(1)));
  dictionary = () => Object.fromEntries(Array.from({ length: this.count(8) }, () => [this.text(), this.text()]));
  /** @template T @param {number} size bytes per entry, or more @param {() => T} read */
  list = (size, read) => Array.from({ length: this.count(size) }, read);
}

/** @param {string} name @param {Uint8Array} bytes */ export function readChunks(name, bytes) {
  const reader = new Reader(name, bytes, 0, bytes.length, "header");
  if (new TextDecoder("latin1").decode(reader.take(4)) !== "VOX ")
    throw new Error(`${name}: does not start with 'VOX '; name a MagicaVoxel file`);
  const version = reader.integer();
  if (version !== 150 && version !== 200)
    throw new Error(`${name}: version ${version} is none of (150, 200); save it with MagicaVoxel 0.98 or later`);
  /** @type {VoxFile} */
  const file = { models: [], nodes: new Map(), hidden: new Set(), kinds: new Map(), palette: defaultColour };
  /** @type {number[] | null} */ let size = null;
  while (reader.at < reader.end) {
    const kind = new TextDecoder("latin1").decode(reader.take(4));
    const start = reader.at + 8;
    const [length, children] = [reader.integer(), reader.integer()];
    if (length < 0 || children < 0 || length + children > bytes.length - start)
      throw new Error(
        `${name}: chunk ${kind} at byte ${start - 12}: should have ${length} + ${children} bytes, and ${bytes.length - start} follow; the file is cut short or damaged; save it again`,
      );
    const content = new Reader(name, bytes, start, start + length, kind);
    reader.at = start + length;
    if (kind === "SIZE") size = sizeOf(content);
    else if (kind === "XYZI") {
      if (!size) throw content.fault("has no SIZE before it");
      file.models.push({ size, voxels: voxelsOf(content, size) });
      size = null;
    } else PARSERS[kind]?.(content, file);
  }
  return file;
}

/** @param {Reader} content */ function sizeOf(content) {
  const size = [content.integer(), content.integer(), content.integer()];
  if (size.some((side) => side < 1 || side > 256))
    throw content.fault(`a model of (${size.join(", ")}) voxels is outside 1 ... 256`);
  return size;
}

/** @param {Reader} content @param {number[]} size */ function voxelsOf(content, size) {
  const voxels = content.take(4 * content.count(4));
  for (let i = 0; i < voxels.length; i += 4)
    if (voxels[i] >= size[0] || voxels[i + 1] >= size[1] || voxels[i + 2] >= size[2] || voxels[i + 3] === 0)
      throw content.fault(
        `voxel (${voxels[i]}, ${voxels[i + 1]}, ${voxels[i + 2]}) of colour ${voxels[i + 3]} does not belong in a model of (${size.join(", ")})`,
      );
  return voxels;
}

/** @type {Record<string, (content: Reader, file: VoxFile) => void>} */ const PARSERS = {
  RGBA(content, file) {
    const rows = content.take(1024);
    file.palette = (colour) => [...rows.subarray(4 * colour - 4, 4 * colour - 1)];
  },
  nTRN(content, file) {
    const [node, attributes] = [content.integer(), content.dictionary()];
    const [child, , layer] = [content.integer(), content.integer(), content.integer()];
    const frames = content.list(4, () => content.dictionary());
    const { _r: turn = "4", _t: move = "0 0 0" } = frames[0] ?? {};
    const [rows, offset, hidden] = [rotation(content, turn), offsetOf(content, move), attributes._hidden === "1"];
    file.nodes.set(node, { child, rows, offset, hidden, layer, frames: frames.length });
  },
  nGRP(content, file) {
    const node = content.integer();
    content.dictionary();
    file.nodes.set(node, { children: content.list(4, () => content.integer()) });
  },
  nSHP(content, file) {
    const node = content.integer();
    content.dictionary();
    file.nodes.set(node, {
      models: content.list(8, () => {
        const model = content.integer();
        content.dictionary();
        return model;
      }),
    });
  },
  LAYR(content, file) {
    const layer = content.integer();
    if (content.dictionary()._hidden === "1") file.hidden.add(layer);
  },
  MATL(content, file) {
    const colour = content.integer();
    const { _type: kind = "_diffuse" } = content.dictionary();
    if (kind !== "_diffuse") file.kinds.set(colour & 255, kind);
  },
};

/** Two bits give the column of each of two rows, one bit a sign. @param {Reader} content @param {string} text */
function rotation(content, text) {
  const bits = /^\d{1,3}$/.test(text) ? Number(text) : 3;
  const [first, second] = [bits & 3, (bits >> 2) & 3];
  if (first === 3 || second === 3 || second === first || bits >> 7)
    throw content.fault(`'${text.slice(0, 20)}' is not a rotation`);
  return [first, second, 3 - first - second].map((column, row) =>
    [0, 1, 2].map((at) => (at === column ? ((bits >> (4 + row)) & 1 ? -1 : 1) : 0)),
  );
}

/** @param {Reader} content @param {string} text */ function offsetOf(content, text) {
  const parts = text.slice(0, 64).trim().split(/\s+/);
  if (parts.length !== 3 || parts.some((part) => !/^[+-]?\d+$/.test(part) || Math.abs(Number(part)) >= 2 ** 31))
    throw content.fault(`'${text.slice(0, 20)}' is not a translation`);
  return parts.map(Number);
}

/** Without a palette: a 6x6x6 cube from white down, without black, then four ramps. @param {number} colour */
function defaultColour(colour) {
  const at = colour - 1;
  if (at < 215) return [Math.floor(at / 36), Math.floor(at / 6) % 6, at % 6].map((step) => 255 - 51 * step);
  const value = [0xee, 0xdd, 0xbb, 0xaa, 0x88, 0x77, 0x55, 0x44, 0x22, 0x11][(at - 215) % 10];
  const ramp = Math.floor((at - 215) / 10);
  return [0, 1, 2].map((axis) => (ramp === 3 || ramp === axis ? value : 0));
}
