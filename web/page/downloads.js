// What the page hands out: the memory as .mem, its manifest, a link to the scene and the view.

import { crc32 } from "./crc32.js";
import { memBytes } from "./mem.js";

export function save(bytes, name, type = "application/octet-stream") {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes], { type }));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

// The manifest of a memory, as voxrt build writes it (export/manifest.py): its own, if it came with one.
export function manifestOf(
  { name, file, words, depth, materials, grid, objects, warnings, seconds, fill, lighting, baked, manifest },
  voxels,
) {
  const crc = crc32(memBytes(words)).toString(16).toUpperCase().padStart(8, "0");
  if (manifest) return { ...manifest, crc32: crc };
  const [x, y, z] = grid?.origin ?? [0, 0, 0];
  const size = grid?.voxelSize;
  return {
    schema: 1,
    name,
    words: words.length,
    blocks: (words.length - 1) / 8,
    depth,
    dialect: "report",
    crc32: crc,
    voxels: voxels.reduce((sum, count, id) => (id ? sum + count : 0), 0),
    materials: materials.map((material, id) => ({
      id,
      name: material.name,
      colour: material.colour,
      mirror: material.mirror,
      authored: material.authored,
      voxels: voxels[id],
    })),
    world: grid && {
      origin: grid.origin,
      voxel_size: size,
      matrix: [
        [size, 0, 0, x],
        [0, size, 0, y],
        [0, 0, size, z],
        [0, 0, 0, 1],
      ],
    },
    objects: objects.map((object) => ({ source: "mesh", moved: [0, 0, 0], grown: [0, 0, 0], ...object })),
    warnings,
    seconds: { build: seconds ?? 0 },
    source: { file, settings: { fill: fill ?? null } },
    view: null,
    lighting: lighting ?? null,
    animation: null,
    baked: baked
      ? {
          sun: baked.sun,
          sky: baked.sky,
          samples: baked.samples,
          voxels: baked.voxels,
          colours: baked.colours,
          words_before: baked.wordsBefore,
          words: baked.words,
        }
      : null,
  };
}

const NUMBERS = /^-?\d+(\.\d+)?$/;

// The part of an address that carries a scene and its view, and back.
export function linkOf({ example, depth, bake, words, view }) {
  const { eye, yaw, pitch, fov, distance } = view;
  const camera = [...eye, yaw, pitch, fov, distance].map((value) => Number(value.toFixed(3))).join(",");
  const light = bake ? { bake: [...bake.sun, bake.sky[0], bake.samples].join(",") } : {};
  return `#${new URLSearchParams({ ...(example ? { scene: example } : {}), depth, ...light, ...(words ? { words } : {}), camera })}`;
}

export function readLink(hash) {
  const given = new URLSearchParams(hash.slice(1));
  const read = (name, count) => {
    const parts = (given.get(name) ?? "").split(",");
    return parts.length === count && parts.every((part) => NUMBERS.test(part)) ? parts.map(Number) : null;
  };
  const numbers = read("camera", 7);
  const words = Number(given.get("words"));
  const light = read("bake", 5);
  const samples = light?.[4];
  const depth = Number(given.get("depth"));
  return {
    example: given.get("scene"),
    depth: Number.isInteger(depth) && depth >= 1 && depth <= 12 ? depth : null,
    bake:
      light && light[3] >= 0 && light[3] <= 16 && Number.isInteger(samples) && samples >= 1 && samples <= 4096
        ? { sun: light.slice(0, 3), sky: [light[3], light[3], light[3]], samples }
        : null,
    words: Number.isInteger(words) && words >= 1 && words < 2 ** 32 ? words : null,
    camera: numbers && {
      eye: numbers.slice(0, 3),
      yaw: numbers[3],
      pitch: numbers[4],
      fov: numbers[5],
      distance: numbers[6],
    },
  };
}
