/** An error of the input: one line, what is wrong and how to fix it. */
export class VoxrtError extends Error {}

export type Triple = readonly [number, number, number];
export type Fill = "surface" | "solid" | "auto";

export interface Material {
  name: string;
  /** sRGB, 0 … 255. */
  colour: Triple;
  mirror?: boolean;
  /** False for one that replaces a missing material. */
  authored?: boolean;
}

export interface Mesh {
  /** Three numbers per vertex. */
  positions: ArrayLike<number>;
  /** Three vertices per triangle, counter-clockwise seen from outside. */
  triangles: ArrayLike<number>;
  /** A material per triangle: 1 is the first of the scene; 0 where the surface gives an appearance. */
  materials: ArrayLike<number>;
  surface?: Surface;
  /** For baked light: three numbers per direction, of any length, zeros for none; the direction of each corner, or -1. */
  normals?: { directions: ArrayLike<number>; rows: ArrayLike<number> };
}

/** Row 0 is at v = 0; 4 bytes per pixel: sRGB and alpha. */
export interface Image {
  width: number;
  height: number;
  pixels: ArrayLike<number>;
}

export interface Appearance {
  name: string;
  /** Linear red, green, blue and alpha, multiplied with the texture and the vertex colours. */
  factor?: readonly [number, number, number, number];
  texture?: { image: Image; wrap?: readonly [Wrap, Wrap]; nearest?: boolean } | null;
  /** The surface is cut away where its alpha is below this; 0 for opaque ones. */
  cutoff?: number;
  mirror?: boolean;
}

export type Wrap = "repeat" | "mirror" | "clamp";

/** Textures and vertex colours of a mesh. */
export interface Surface {
  entries: Appearance[];
  /** Each triangle's entry, or -1. */
  rows: ArrayLike<number>;
  /** u and v of the three corners of each triangle. */
  uv: ArrayLike<number>;
  /** Linear colour and alpha of the three corners of each triangle. */
  colours: ArrayLike<number>;
}

export interface SceneObject {
  name: string;
  /** Index into the scene's meshes. */
  mesh: number;
  /** Rows of a 3 x 4 matrix to the scene frame: right-handed, metres, y up. */
  transform: ArrayLike<number>;
}

export interface Scene {
  materials: Material[];
  meshes: Mesh[];
  objects: SceneObject[];
}

export interface Warning {
  kind: string;
  message: string;
  count: number;
}

export interface Built {
  /** The octree memory: pointers to blocks of eight words, and leaves 0xFFFFFFmm. */
  words: Uint32Array;
  depth: number;
  grid: { origin: number[]; voxelSize: number };
  /** By id; entry 0 is empty space, with the background's colour. */
  materials: Required<Material>[];
  objects: { name: string; mode: string; voxels: number }[];
  warnings: Warning[];
  /** What was baked; null without baked light. Such a memory is shown flat. */
  baked: (Daylight & { voxels: number; colours: number; wordsBefore: number; words: number }) | null;
  /** What a budget gave up, in voxels; null without one. */
  fitted: {
    words: number; wordsBefore: number; wordsShared: number; surface: number; changed: number; appeared: number;
    recoloured: number; colours: number;
  } | null;
}

/** A distant sun and a sky that shines evenly. */
export interface Daylight {
  /** The direction towards the sun; zeros for none. */
  sun: Triple;
  /** Linear red, green and blue. */
  sky: Triple;
  /** Rays to the sky per voxel, 1 … 4096. */
  samples: number;
}

export interface Camera {
  /** 1/16 voxel. */
  position: Triple;
  /** Whole numbers below 2^15; direction(column, row) = look + right (column - W/2) + up (H/2 - row). */
  look: Triple;
  right: Triple;
  up: Triple;
}

export interface Look {
  /** sRGB by id; entry 0 is the background. */
  materials: ArrayLike<number>[];
  /** Ids of mirrors. */
  mirrors?: number[];
  bounces?: number;
  flat?: boolean;
  /** 1/255, of the faces that look along -x, +x, -y, +y, -z, +z; null: by the angle. */
  faces?: ArrayLike<number> | null;
  /** Position in 1/16 voxel; ambient 0 … 255. */
  light?: { position: Triple; ambient: number } | null;
}

export interface Rows {
  /** The first row of pixels. */
  top: number;
  /** RGB, row by row. */
  colour: Uint8Array;
  material: Uint8Array;
  /** The axis of the face hit; 3 for none. */
  face: Uint8Array;
  wordsRead: number;
}

export interface Reading {
  address: number;
  word: number;
  /** The word's octant has 2^level voxels per side. */
  level: number;
  corner: number[];
  /** Of the plane that the ray crossed last; 3 for none. */
  axis: number;
}

export const FACES: number[];
export const FILLS: Fill[];
export const BACKGROUND: number[];
export const DEPTH_LIMIT: 16;
export const DAYLIGHT: Daylight;

export class Voxrt {
  /** `source`: voxrt.wasm as bytes, as a Response or as a module. */
  static load(source: BufferSource | Response | WebAssembly.Module): Promise<Voxrt>;
  /** Voxelize a scene and build its octree. `depth` 1 … 16 (7), `fill` (auto), `budget`: the most words. */
  voxelize(scene: Scene, options?: { depth?: number; fill?: Fill; colours?: number; bake?: Daylight | null; budget?: number | null }): Built;
  /** The words of voxels given one by one: three whole numbers from 0 up to 2 ** depth and a material, 1 … 255, each. */
  fromPoints(places: ArrayLike<number>, materials: ArrayLike<number>, depth: number): Uint32Array;
  /** Take the words of an octree memory, which are checked. */
  setMemory(words: ArrayLike<number>, depth: number): void;
  /** The least depth of the world that words describe. */
  depthOf(words: ArrayLike<number>): number;
  /** The least number of levels by which the memory must be coarser to have at most so many words. */
  levelThatFits(words: number): number;
  /** How hits are coloured. */
  shade(look: Look): void;
  /** Render a frame, or its rows of tiles `first` up to and without `end`; a tile is 16 pixels high. */
  render(camera: Camera, size: readonly [number, number], first?: number, end?: number): Rows;
  /** The same for a canvas: RGBA as ImageData takes it, in the buffer that is given if it has the right size. */
  renderImage(camera: Camera, size: readonly [number, number], first?: number, end?: number, buffer?: ArrayBuffer | null): {
    top: number; pixels: Uint8ClampedArray;
  };
  tileRows(height: number): number;
  /** Follow one ray: origin in 1/16 voxel, direction below 2^20. */
  follow(origin: ArrayLike<number>, direction: ArrayLike<number>): {
    readings: Reading[]; material: number; face: number; cell: number[] | null;
  };
  /** The voxels of the memory by material: 256 numbers. */
  voxels(): number[];
  /** Cubes that hold all that is solid: x, y, z of the lowest corner and the side, each. */
  outline(): Int32Array;
  /** Linear light, 0 … 1, as sRGB, 0 … 255. */
  srgb(linear: number): number;
  /** sRGB, 0 … 255, as linear light. */
  linear(code: number): number;
  /** Bytes of memory in use. */
  readonly bytes: number;
}
