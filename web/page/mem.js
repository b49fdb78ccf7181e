// .mem files: octree words as text for $readmemh, one word per line; and the manifest beside them.

const CRC = Uint32Array.from({ length: 256 }, (_, n) => {
  for (let bit = 0; bit < 8; bit++) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
  return n >>> 0;
});

export function crc32(bytes) {
  let crc = 0xffffffff;
  for (const byte of bytes) crc = CRC[(crc ^ byte) & 255] ^ (crc >>> 8);
  return (crc ^ 0xffffffff) >>> 0;
}

// The bytes of a .mem file.
export function memBytes(words) {
  const digits = new TextEncoder().encode("0123456789ABCDEF");
  const bytes = new Uint8Array(9 * words.length);
  words.forEach((word, i) => {
    for (let digit = 0; digit < 8; digit++) bytes[9 * i + digit] = digits[(word >>> (28 - 4 * digit)) & 15];
    bytes[9 * i + 8] = 10;
  });
  return bytes;
}

// Read words of the report dialect, and what their manifest ({bytes}, or none) says: {words, depth, materials, objects, grid}.
export function readMem(name, bytes, manifest) {
  const text = new TextDecoder().decode(bytes).replace(/\/\*[\s\S]*?\*\/|\/\/[^\n]*/g, " ");
  const parts = text.split(/\s+/).filter(Boolean);
  const broken = parts.findIndex((part) => !/^[0-9A-Fa-f_]{1,16}$/.test(part));
  if (broken >= 0) throw new Error(`${name}: word ${broken} is ${JSON.stringify(parts[broken].slice(0, 20))}, which is not hexadecimal`);
  if (!parts.length) throw new Error(`${name}: has no words`);
  const words = Uint32Array.from(parts, (part) => parseInt(part.replaceAll("_", ""), 16));
  const known = manifest ? JSON.parse(new TextDecoder().decode(manifest.bytes)) : null;
  if (known && known.words !== words.length) throw new Error(`${name}: has ${words.length} words, and its manifest says ${known.words}`);
  const materials = known?.materials ?? Array.from({ length: 256 }, (_, id) => ({ name: id ? `material ${id}` : "empty", colour: tint(id), mirror: false, authored: false }));
  const grid = known?.world ? { origin: known.world.origin, voxelSize: known.world.voxel_size } : null;
  return { words, depth: known?.depth ?? null, materials, grid, objects: known?.objects ?? [], warnings: known?.warnings ?? [] };
}

// Distinct colours for ids without a table.
function tint(id) {
  if (id === 0) return [24, 28, 36];
  const hue = (id * 137.508) % 360;
  const channel = (shift) => Math.round(255 * (0.62 + 0.3 * Math.cos(((hue + shift) * Math.PI) / 180)));
  return [channel(0), channel(240), channel(120)];
}
