// MagicaVoxel files: coloured voxels of every instance of every model. z is up there and y here: voxel (x, y, z) goes to
// (x, z, -y), a rotation.

const VOXEL_LIMIT = 1 << 25;
const INSTANCE_LIMIT = 1 << 16;
const NESTING_LIMIT = 256;
const DEPTH_LIMIT = 16;
const IDENTITY = [
  [1, 0, 0],
  [0, 1, 0],
  [0, 0, 1],
];
const DAMAGED = "the file is damaged; save it again";

// Returns {words, depth, materials, objects, grid, warnings}, as readMem does.
export function readVox(name, bytes, voxrt) {
  const file = readChunks(name, bytes);
  const { instances, warnings } = instancesOf(name, file);
  const total = instances.reduce((sum, { model }) => sum + file.models[model].voxels.length / 4, 0);
  if (!total) throw new Error(`${name}: holds no visible voxel; show at least one model`);
  if (total > VOXEL_LIMIT)
    throw new Error(`${name}: ${total} voxels, and ${VOXEL_LIMIT} are the most; save fewer instances`);
  const places = new Float64Array(3 * total);
  const colours = new Uint8Array(total);
  let at = 0;
  for (const { model, rows, offset } of instances) {
    const { size, voxels } = file.models[model];
    for (let i = 0; i < voxels.length; i += 4, at++) {
      const centre = size.map((side, axis) => 2 * (voxels[i + axis] - (side >> 1)) + 1);
      const [x, y, z] = rows.map((row, axis) => Math.floor((dot(row, centre) + 2 * offset[axis]) / 2));
      places.set([x, z, -1 - y], 3 * at);
      colours[at] = voxels[i + 3];
    }
  }
  const [low, high] = [
    [Infinity, Infinity, Infinity],
    [-Infinity, -Infinity, -Infinity],
  ];
  places.forEach((value, i) => {
    low[i % 3] = Math.min(low[i % 3], value);
    high[i % 3] = Math.max(high[i % 3], value);
  });
  const span = Math.max(...low.map((value, axis) => high[axis] - value)) + 1;
  const depth = Math.max(1, Math.ceil(Math.log2(span)));
  if (depth > DEPTH_LIMIT)
    throw new Error(`${name}: ${span} voxels from end to end do not fit depth ${DEPTH_LIMIT}; move the parts closer`);
  const used = [...new Set(colours)].sort((a, b) => a - b);
  const ids = new Map(used.map((colour, i) => [colour, i + 1]));
  const words = voxrt.fromPoints(
    places.map((value, i) => value - low[i % 3]),
    colours.map((colour) => ids.get(colour)),
    depth,
  );
  const materials = [
    { name: "empty", colour: [24, 28, 36], mirror: false, authored: true },
    ...used.map((colour) => ({
      name: `colour ${colour}`,
      colour: file.palette(colour),
      mirror: false,
      authored: true,
    })),
  ];
  const kinds = used.map((colour) => file.kinds.get(colour)).filter(Boolean);
  if (kinds.length)
    warnings.push({
      kind: "vox-material",
      message: `${[...new Set(kinds)]
        .sort()
        .map((kind) => kind.replaceAll("_", ""))
        .join(", ")} materials became plain colours`,
      count: kinds.length,
    });
  return { words, depth, materials, objects: [], grid: null, warnings };
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

// A part of the file, read from its start to its end.
class Reader {
  constructor(name, bytes, at, end, kind) {
    Object.assign(this, { name, bytes, at, end, place: `chunk ${kind} at byte ${at}` });
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }
  fault(problem) {
    return new Error(`${this.name}: ${this.place}: ${problem}; ${DAMAGED}`);
  }
  take(count) {
    if (count < 0 || count > this.end - this.at)
      throw this.fault(`${count} bytes should follow, and ${this.end - this.at} do`);
    this.at += count;
    return this.bytes.subarray(this.at - count, this.at);
  }
  integer() {
    this.take(4);
    return this.view.getInt32(this.at - 4, true);
  }
  count(size) {
    const count = this.integer();
    if (count < 0 || count > Math.floor((this.end - this.at) / size))
      throw this.fault(`${count} entries should follow, and the chunk is too short for them`);
    return count;
  }
  text() {
    return new TextDecoder().decode(this.take(this.count(1)));
  }
  dictionary() {
    return Object.fromEntries(Array.from({ length: this.count(8) }, () => [this.text(), this.text()]));
  }
  list(size, read) {
    return Array.from({ length: this.count(size) }, read);
  }
}

function readChunks(name, bytes) {
  const reader = new Reader(name, bytes, 0, bytes.length, "header");
  if (new TextDecoder("latin1").decode(reader.take(4)) !== "VOX ")
    throw new Error(`${name}: does not start with 'VOX '; name a MagicaVoxel file`);
  const version = reader.integer();
  if (version !== 150 && version !== 200)
    throw new Error(`${name}: version ${version} is none of (150, 200); save it with MagicaVoxel 0.98 or later`);
  const file = { models: [], nodes: new Map(), hidden: new Set(), kinds: new Map(), palette: defaultColour };
  let size = null;
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

function sizeOf(content) {
  const size = [content.integer(), content.integer(), content.integer()];
  if (size.some((side) => side < 1 || side > 256))
    throw content.fault(`a model of (${size.join(", ")}) voxels is outside 1 ... 256`);
  return size;
}

function voxelsOf(content, size) {
  const voxels = content.take(4 * content.count(4));
  for (let i = 0; i < voxels.length; i += 4)
    if (voxels[i] >= size[0] || voxels[i + 1] >= size[1] || voxels[i + 2] >= size[2] || voxels[i + 3] === 0)
      throw content.fault(
        `voxel (${voxels[i]}, ${voxels[i + 1]}, ${voxels[i + 2]}) of colour ${voxels[i + 3]} does not belong in a model of (${size.join(", ")})`,
      );
  return voxels;
}

const PARSERS = {
  RGBA(content, file) {
    const rows = content.take(1024);
    file.palette = (colour) => [...rows.subarray(4 * colour - 4, 4 * colour - 1)];
  },
  nTRN(content, file) {
    const [node, attributes] = [content.integer(), content.dictionary()];
    const [child, , layer] = [content.integer(), content.integer(), content.integer()];
    const frames = content.list(4, () => content.dictionary());
    const { _r: turn = "4", _t: move = "0 0 0" } = frames[0] ?? {};
    file.nodes.set(node, {
      child,
      rows: rotation(content, turn),
      offset: offsetOf(content, move),
      hidden: attributes._hidden === "1",
      layer,
      frames: frames.length,
    });
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

// Two bits per row give the column of the first two rows, one bit per row gives its sign.
function rotation(content, text) {
  const bits = /^\d{1,3}$/.test(text) ? Number(text) : 3;
  const [first, second] = [bits & 3, (bits >> 2) & 3];
  if (first === 3 || second === 3 || second === first || bits >> 7)
    throw content.fault(`'${text.slice(0, 20)}' is not a rotation`);
  return [first, second, 3 - first - second].map((column, row) =>
    [0, 1, 2].map((at) => (at === column ? ((bits >> (4 + row)) & 1 ? -1 : 1) : 0)),
  );
}

function offsetOf(content, text) {
  const parts = text.slice(0, 64).trim().split(/\s+/);
  if (parts.length !== 3 || parts.some((part) => !/^[+-]?\d+$/.test(part) || Math.abs(Number(part)) >= 2 ** 31))
    throw content.fault(`'${text.slice(0, 20)}' is not a translation`);
  return parts.map(Number);
}

// The instances of the scene graph; without one, every model is shown at the origin.
function instancesOf(name, file) {
  if (!file.nodes.size)
    return { instances: file.models.map((_, model) => ({ model, rows: IDENTITY, offset: [0, 0, 0] })), warnings: [] };
  const instances = [];
  let [hidden, animated, visited] = [0, 0, 0];
  const waiting = [{ number: 0, rows: IDENTITY, offset: [0, 0, 0], above: [] }];
  while (waiting.length) {
    const { number, rows, offset, above } = waiting.pop();
    const node = file.nodes.get(number);
    visited++;
    if (!node || above.includes(number))
      throw new Error(`${name}: scene node ${number}: ${node ? "holds itself" : "is not there"}; ${DAMAGED}`);
    if (visited > INSTANCE_LIMIT || above.length > NESTING_LIMIT)
      throw new Error(
        `${name}: more than ${INSTANCE_LIMIT} scene nodes, or ${NESTING_LIMIT} in one another; save fewer`,
      );
    const here = [...above, number];
    if ("child" in node) {
      if (node.hidden || file.hidden.has(node.layer)) {
        hidden++;
        continue;
      }
      animated += node.frames > 1;
      const local = rows.map((row) =>
        [0, 1, 2].map(
          (column) => row[0] * node.rows[0][column] + row[1] * node.rows[1][column] + row[2] * node.rows[2][column],
        ),
      );
      waiting.push({
        number: node.child,
        rows: local,
        offset: rows.map((row, axis) => dot(row, node.offset) + offset[axis]),
        above: here,
      });
    } else if (node.children) {
      for (const child of [...node.children].reverse()) waiting.push({ number: child, rows, offset, above: here });
    } else {
      animated += node.models.length > 1;
      const [model] = node.models;
      if (!node.models.length || node.models.some((one) => one < 0 || one >= file.models.length))
        throw new Error(`${name}: scene node ${number}: shows no model of 0 ... ${file.models.length - 1}; ${DAMAGED}`);
      instances.push({ model, rows, offset });
    }
  }
  const warnings = [];
  if (hidden) warnings.push({ kind: "vox-hidden", message: "nodes that the author hid are left out", count: hidden });
  if (animated)
    warnings.push({
      kind: "vox-animation",
      message: "only the first frame of animated nodes is shown",
      count: animated,
    });
  return { instances, warnings };
}

// Files without a palette: a 6x6x6 cube from white down (black left out), then four ramps of ten.
function defaultColour(colour) {
  const at = colour - 1;
  if (at < 215) return [Math.floor(at / 36), Math.floor(at / 6) % 6, at % 6].map((step) => 255 - 51 * step);
  const value = [0xee, 0xdd, 0xbb, 0xaa, 0x88, 0x77, 0x55, 0x44, 0x22, 0x11][(at - 215) % 10];
  const ramp = Math.floor((at - 215) / 10);
  return [0, 1, 2].map((axis) => (ramp === 3 || ramp === axis ? value : 0));
}
