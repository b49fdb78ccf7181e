// What Voxrt.voxelize takes and gives.

/** @typedef {readonly number[]} Triple three numbers */
/** @typedef {"solid" | "surface" | "auto"} Fill what surfaces enclose is filled or not */
/** @typedef {"touch" | "centre" | "half"} Rule which voxels of solids are filled */
/** @typedef {"repeat" | "mirror" | "clamp"} Wrap */

/** `colour`: sRGB, 0 … 255; `authored`: false for one that replaces a missing material. @typedef {{ name: string,
 * colour: Triple, mirror?: boolean, authored?: boolean }} Material */

/** Row 0 is at v = 0; pixels have 4 bytes: sRGB and alpha. @typedef {{ width: number, height: number, pixels:
 * ArrayLike<number> }} Image */

/** `factor`: linear red, green, blue and alpha, multiplied with the texture and the vertex colours; `texture`: it is
 * continued by `wrap` along u, v; `cutoff`: the surface is cut away where its alpha is below this; 0 for opaque
 * ones. @typedef {{ name: string, factor?: readonly number[], texture?: { image: Image, wrap?: readonly Wrap[],
 * nearest?: boolean } | null, cutoff?: number, mirror?: boolean }} Appearance */

/** Textures and vertex colours of a mesh. `rows`: each triangle's entry, or -1; `uv`: u and v of the three corners
 * of each triangle; `colours`: linear colour and alpha of the three corners of each triangle. @typedef {{ entries:
 * Appearance[], rows: ArrayLike<number>, uv: ArrayLike<number>, colours: ArrayLike<number> }} Surface */

/** For baked light: three numbers per direction, of any length, zeros for none; the direction of each corner, or -1.
 * @typedef {{ directions: ArrayLike<number>, rows: ArrayLike<number> }} Normals */

/** `positions`: three numbers per vertex; `triangles`: three vertices per triangle, counter-clockwise seen from
 * outside; `materials`: per triangle: 1 is the first of the scene; 0 where the surface has an appearance. @typedef
 * {{ positions: ArrayLike<number>, triangles: ArrayLike<number>, materials: ArrayLike<number>, surface?: Surface,
 * normals?: Normals }} Mesh */

/** `mesh`: index into the scene's meshes; `transform`: rows of a 3 x 4 matrix to the scene frame: right-handed,
 * metres, y up; `rule`, `fill`: its own ones. @typedef {{ name: string, mesh: number, transform: ArrayLike<number>,
 * rule?: Rule | null, fill?: Fill | null }} SceneObject */

/** @typedef {{ materials: Material[], meshes: Mesh[], objects: SceneObject[] }} Scene */
/** @typedef {{ kind: string, message: string, count: number }} Warning */

/** A distant sun and a sky that shines evenly. `sun`: the direction towards the sun; zeros for none; `sky`: linear
 * red, green and blue; `samples`: rays to the sky per voxel, 1 … 4096. @typedef {{ sun: Triple, sky: Triple,
 * samples: number }} Daylight */

/** `depth`: 1 … 16; `colours`: the most for all textures and vertex colours; `bake`: light that is put into the
 * colours; `budget`: the most words that the memory may have; it gives up what is seen least. @typedef {{ depth?:
 * number, fill?: Fill, rule?: Rule, colours?: number, bake?: Daylight | null, budget?: number | null }} Options */

/** @typedef {Daylight & { voxels: number, colours: number, wordsBefore: number, words: number }} Baked */

/** What a budget gave up, in voxels. @typedef {{ words: number, wordsBefore: number, wordsShared: number, surface:
 * number, changed: number, appeared: number, recoloured: number, colours: number }} Fitted */

/** `words`: the octree memory: pointers to blocks of eight words, and leaves 0xFFFFFFmm; `materials`: by id; entry 0
 * is empty space, with the background's colour; `baked`: what was baked; such a memory is shown flat. @typedef {{
 * words: Uint32Array, depth: number, grid: { origin: number[], voxelSize: number }, materials:
 * Required<Material>[], objects: { name: string, mode: string, rule: Rule, voxels: number }[], warnings: Warning[], baked:
 * Baked | null, fitted: Fitted | null }} Built */

/** @type {readonly Fill[]} */ export const FILLS = ["solid", "surface", "auto"];
/** @type {readonly Rule[]} */ export const RULES = ["touch", "centre", "half"];
export const DEPTH_LIMIT = 16;
/** @type {readonly Wrap[]} */ export const WRAPS = ["repeat", "mirror", "clamp"];
/** @type {Daylight} */ export const DAYLIGHT = { sun: [1, 3, 2], sky: [0.4, 0.4, 0.4], samples: 64 };
export const BAKED_COLOURS = 254;
export const COLOURS = 32; // for all textures and vertex colours of a scene
