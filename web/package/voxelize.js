// A scene as voxels in an octree memory.

import { textBytes, VoxrtError } from "./instance.js";
import { leftOut } from "./opacity.js";
import { BAKED_COLOURS, COLOURS, DEPTH_LIMIT, FILLS, RULES, WRAPS } from "./scene_format.js";
/** @import { Appearance, Baked, Built, Daylight, Fitted, Image, Options, Rule, Scene } from "./scene_format.js" */
/** @import { Voxrt } from "./voxrt.js" */

const MIRROR = 1 << 24;
const AUTHORED = 1 << 25;

/** @param {Voxrt} voxrt @param {Scene} scene @param {Options} options @returns {Built} */
export function voxelize(voxrt, scene, options) {
  const { depth = 7, fill = "auto", rule = "touch", colours = COLOURS, bake = null, budget = null } = options;
  if (!Number.isInteger(depth) || depth < 1 || depth > DEPTH_LIMIT)
    throw new VoxrtError(`depth must be 1 … 16, not ${depth}`);
  if (!FILLS.includes(fill)) throw new VoxrtError(`fill must be ${FILLS.join(", ")}, not ${fill}`);
  if (!RULES.includes(rule)) throw new VoxrtError(`rule must be ${RULES.join(", ")}, not ${rule}`);
  const { wasm } = voxrt;
  return voxrt.guard(() => {
    const transparent = describe(voxrt, scene, bake !== null);
    voxrt.checked(wasm.vx_voxelize(depth, FILLS.indexOf(fill), RULES.indexOf(rule), colours));
    const baked = bake && bakeLight(voxrt, bake);
    const fitted = budget ? fit(voxrt, budget) : null;
    if (baked && fitted) baked.colours = fitted.colours;
    const rules = scene.objects.map((object) => object.rule ?? rule);
    const built = { ...read(voxrt, rules), depth, baked, fitted };
    const left = { kind: "transparent", message: reasonOf(scene), count: transparent };
    if (transparent) built.warnings.unshift(left);
    wasm.vx_scene_begin();
    return built;
  });
}

/** Why faces of a scene are cut away. @param {Scene} scene */
function reasonOf({ meshes }) {
  const cutoffs = meshes.flatMap(({ surface }) => surface?.entries.map(({ cutoff }) => cutoff || 0) ?? []);
  return leftOut(Number.MIN_VALUE, Math.max(...cutoffs)) ?? "";
}

/** Hand a scene to the module; returns how many triangles are cut away. @param {Voxrt} voxrt @param {Scene}
 * scene @param {boolean} hasNormals */
function describe(voxrt, { materials, meshes, objects }, hasNormals) {
  const { wasm } = voxrt;
  wasm.vx_scene_begin();
  for (const { name, colour, mirror = false, authored = true } of materials) {
    const [red, green, blue] = colour;
    voxrt.with([Uint8Array], [textBytes(name)], (text) =>
      voxrt.checked(wasm.vx_material(text, (red << 16) | (green << 8) | blue, mirror, authored)),
    );
  }
  /** @type {Map<Appearance, number>} */ const appearances = new Map();
  /** @type {Map<Image, number>} */ const images = new Map();
  for (const { positions, triangles, materials: ids, normals, surface } of meshes) {
    voxrt.with([Float64Array, Int32Array, Uint8Array], [positions, triangles, ids], (at, corners, list) =>
      voxrt.checked(wasm.vx_mesh(at, positions.length / 3, corners, triangles.length / 3, list)),
    );
    if (hasNormals && normals)
      voxrt.with([Float64Array, Int32Array], [normals.directions, normals.rows], (at, rows) =>
        voxrt.checked(wasm.vx_normals(at, normals.directions.length / 3, rows)),
      );
    if (!surface) continue;
    const { entries, rows, uv, colours } = surface;
    const numbers = entries.map((entry) => {
      const number = appearances.get(entry) ?? addAppearance(voxrt, entry, images);
      appearances.set(entry, number);
      return number;
    });
    voxrt.with([Int32Array, Int32Array, Float64Array, Float32Array], [numbers, rows, uv, colours], (list, ...at) =>
      voxrt.checked(wasm.vx_surface(list, numbers.length, ...at)),
    );
  }
  for (const { name, mesh, transform, rule = null, fill = null } of objects)
    voxrt.with([Float64Array, Uint8Array], [transform, textBytes(name)], (at, text) =>
      voxrt.checked(wasm.vx_object(mesh, at, text, rule ? RULES.indexOf(rule) : -1, fill ? FILLS.indexOf(fill) : -1)),
    );
  return voxrt.checked(wasm.vx_scene_end());
}

/** @param {Voxrt} voxrt @param {Appearance} appearance @param {Map<Image, number>} images */
function addAppearance(voxrt, { name, factor = [1, 1, 1, 1], texture = null, cutoff = 0, mirror = false }, images) {
  const { wasm } = voxrt;
  const { image, wrap = ["repeat", "repeat"], nearest = false } = texture ?? {};
  if (image && !images.has(image)) images.set(image, wasm.vx_image(voxrt.copy(Uint8Array, image.pixels)));
  const number = image ? (images.get(image) ?? 0) : 0;
  const [u, v] = wrap.map((one) => WRAPS.indexOf(one));
  return voxrt.with([Uint8Array, Float64Array], [textBytes(name), factor], (text, light) =>
    voxrt.checked(
      wasm.vx_appearance(text, light, number, image?.width ?? 0, image?.height ?? 0, u, v, nearest, cutoff, mirror),
    ),
  );
}

/** Put light into the colours. @param {Voxrt} voxrt @param {Daylight} daylight @returns {Baked} */
function bakeLight(voxrt, { sun, sky, samples }) {
  const wordsBefore = voxrt.wasm.vx_word_count();
  const voxels = voxrt.with([Float64Array, Float64Array], [sun, sky], (towards, light) =>
    voxrt.checked(voxrt.wasm.vx_bake(towards, light, samples)),
  );
  return { sun, sky, samples, voxels, colours: BAKED_COLOURS, wordsBefore, words: voxrt.wasm.vx_word_count() };
}

/** Make the memory fit. @param {Voxrt} voxrt @param {number} words @returns {Fitted} */
function fit(voxrt, words) {
  if (!Number.isInteger(words) || words < 1 || words > 2 ** 32 - 1)
    throw new VoxrtError(`budget must be a number of words, 1 or more, not ${words}`);
  const { wasm } = voxrt;
  const wordsBefore = wasm.vx_word_count();
  voxrt.checked(wasm.vx_fit(words));
  const figures = voxrt.view(Float64Array, wasm.vx_fit_figures(), 6);
  const [wordsShared, surface, changed, appeared, recoloured, colours] = figures;
  return { words, wordsBefore, wordsShared, surface, changed, appeared, recoloured, colours };
}

/** Read what was built. @param {Voxrt} voxrt @param {Rule[]} rules of the objects */
function read(voxrt, rules) {
  const { wasm } = voxrt;
  const voxels = voxrt.view(BigInt64Array, wasm.vx_object_voxels(), wasm.vx_object_count()).slice();
  return {
    words: voxrt.view(Uint32Array, wasm.vx_words(), wasm.vx_word_count()).slice(),
    grid: { origin: [...voxrt.view(Float64Array, wasm.vx_origin(), 3)], voxelSize: wasm.vx_voxel_size() },
    materials: Array.from({ length: wasm.vx_material_count() }, (_, id) => {
      const look = wasm.vx_material_look(id);
      const colour = [(look >> 16) & 255, (look >> 8) & 255, look & 255];
      const [mirror, authored] = [(look & MIRROR) !== 0, (look & AUTHORED) !== 0];
      return { name: voxrt.string(wasm.vx_material_name(id)), colour, mirror, authored };
    }),
    objects: Array.from(voxels, (count, i) => ({
      name: voxrt.string(wasm.vx_object_name(i)),
      mode: voxrt.string(wasm.vx_object_mode(i)),
      rule: rules[i],
      voxels: Number(count),
    })),
    warnings: Array.from({ length: wasm.vx_warning_count() }, (_, i) => ({
      kind: voxrt.string(wasm.vx_warning_kind(i)),
      message: voxrt.string(wasm.vx_warning_message(i)),
      count: wasm.vx_warning_objects(i),
    })),
  };
}
