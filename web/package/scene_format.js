// What Voxrt.voxelize takes and gives.

/** @typedef {readonly number[]} Triple three numbers */
/** @typedef {"surface" | "solid" | "auto"} Fill */
/** @typedef {"repeat" | "mirror" | "clamp"} Wrap */

/**
 * @typedef {object} Material
 * @property {string} name
 * @property {Triple} colour sRGB, 0 … 255
 * @property {boolean} [mirror]
 * @property {boolean} [authored] false for one that replaces a missing material
 */

/**
 * Row 0 is at v = 0; pixels have 4 bytes: sRGB and alpha.
 * @typedef {{ width: number, height: number, pixels: ArrayLike<number> }} Image
 */

/**
 * @typedef {object} Appearance
 * @property {string} name
 * @property {readonly number[]} [factor] linear red, green, blue and alpha, multiplied with the texture and the vertex colours
 * @property {{ image: Image, wrap?: readonly Wrap[], nearest?: boolean } | null} [texture] it is continued by `wrap` along u, v
 * @property {number} [cutoff] the surface is cut away where its alpha is below this; 0 for opaque ones
 * @property {boolean} [mirror]
 */

/**
 * Textures and vertex colours of a mesh.
 * @typedef {object} Surface
 * @property {Appearance[]} entries
 * @property {ArrayLike<number>} rows each triangle's entry, or -1
 * @property {ArrayLike<number>} uv u and v of the three corners of each triangle
 * @property {ArrayLike<number>} colours linear colour and alpha of the three corners of each triangle
 */

/**
 * For baked light: three numbers per direction, of any length, zeros for none; the direction of each corner, or -1.
 * @typedef {{ directions: ArrayLike<number>, rows: ArrayLike<number> }} Normals
 */

/**
 * @typedef {object} Mesh
 * @property {ArrayLike<number>} positions three numbers per vertex
 * @property {ArrayLike<number>} triangles three vertices per triangle, counter-clockwise seen from outside
 * @property {ArrayLike<number>} materials per triangle: 1 is the first of the scene; 0 where the surface has an appearance
 * @property {Surface} [surface]
 * @property {Normals} [normals]
 */

/**
 * @typedef {object} SceneObject
 * @property {string} name
 * @property {number} mesh index into the scene's meshes
 * @property {ArrayLike<number>} transform rows of a 3 x 4 matrix to the scene frame: right-handed, metres, y up
 */

/** @typedef {{ materials: Material[], meshes: Mesh[], objects: SceneObject[] }} Scene */
/** @typedef {{ kind: string, message: string, count: number }} Warning */

/**
 * A distant sun and a sky that shines evenly.
 * @typedef {object} Daylight
 * @property {Triple} sun the direction towards the sun; zeros for none
 * @property {Triple} sky linear red, green and blue
 * @property {number} samples rays to the sky per voxel, 1 … 4096
 */

/**
 * @typedef {object} Options
 * @property {number} [depth] 1 … 16
 * @property {Fill} [fill]
 * @property {number} [colours] the most for all textures and vertex colours
 * @property {Daylight | null} [bake] light that is put into the colours
 * @property {number | null} [budget] the most words that the memory may have; it gives up what is seen least
 */

/** @typedef {Daylight & { voxels: number, colours: number, wordsBefore: number, words: number }} Baked */

/**
 * What a budget gave up, in voxels.
 * @typedef {object} Fitted
 * @property {number} words
 * @property {number} wordsBefore
 * @property {number} wordsShared
 * @property {number} surface
 * @property {number} changed
 * @property {number} appeared
 * @property {number} recoloured
 * @property {number} colours
 */

/**
 * @typedef {object} Built
 * @property {Uint32Array} words the octree memory: pointers to blocks of eight words, and leaves 0xFFFFFFmm
 * @property {number} depth
 * @property {{ origin: number[], voxelSize: number }} grid
 * @property {Required<Material>[]} materials by id; entry 0 is empty space, with the background's colour
 * @property {{ name: string, mode: string, voxels: number }[]} objects
 * @property {Warning[]} warnings
 * @property {Baked | null} baked what was baked; such a memory is shown flat
 * @property {Fitted | null} fitted
 */

/** @type {readonly Fill[]} */
export const FILLS = ["surface", "solid", "auto"];
export const DEPTH_LIMIT = 16;
/** @type {readonly Wrap[]} */
export const WRAPS = ["repeat", "mirror", "clamp"];
/** @type {Daylight} */
export const DAYLIGHT = { sun: [1, 3, 2], sky: [0.4, 0.4, 0.4], samples: 64 };
export const BAKED_COLOURS = 254;
export const COLOURS = 32; // for all textures and vertex colours of a scene
