// voxrt in WebAssembly: meshes to voxels, to the words of an octree memory, to exact pictures. One instance has one scene,
// one memory and one frame at a time. Nothing here needs a page: it runs in browsers, workers and Node.
//
//     const voxrt = await Voxrt.load(await fetch("voxrt.wasm"));
//     const built = voxrt.voxelize(scene, { depth: 7 });
//     voxrt.setMemory(built.words, built.depth);
//     voxrt.shade({ materials: built.materials.map((material) => material.colour) });
//     const { colour } = voxrt.render(camera, [640, 480]);
//
// Errors are VoxrtError, one line each.

import { Instance, VoxrtError } from "./instance.js";

export { VoxrtError };

// Brightness, in 1/255, of the faces that look along -x, +x, -y, +y, -z, +z: the default shading.
export const FACES = [189, 189, 140, 255, 219, 219];
export const FILLS = ["surface", "solid", "auto"];
export const DEPTH_LIMIT = 16;
export const BACKGROUND = [24, 28, 36];
export const WRAPS = ["repeat", "mirror", "clamp"];
export const DAYLIGHT = { sun: [1, 3, 2], sky: [0.4, 0.4, 0.4], samples: 64 };
export const BAKED_COLOURS = 254;
export const COLOURS = 32; // for all textures and vertex colours of a scene

export class Voxrt extends Instance {
  // Voxelize a scene and build its octree.
  //
  // scene.materials: [{name, colour: [r, g, b] sRGB, mirror, authored}], of id 1, 2, ...
  // scene.meshes: [{positions, triangles, materials, surface}]: three numbers per vertex, three vertices per triangle, an
  // id per triangle. Triangles of id 0 have an appearance: surface is {entries: [{name, factor, texture, cutoff,
  // mirror}], rows, uv, colours}, with the entry of each triangle or -1; u and v, and linear colour and alpha of its three
  // corners. factor: linear red, green, blue, alpha. texture: {image: {width, height, pixels}, wrap: [along u, along v],
  // nearest}, 4 bytes per pixel. cutoff: the surface is cut away where its alpha is below it.
  // scene.objects: [{name, mesh: index, transform: 12 numbers, rows of 3 x 4, to metres with y up}].
  // Meshes may have normals, for baked light: {directions, rows}, three numbers per direction, of any length, zeros for
  // none; and the direction of each corner of each triangle, or -1.
  // bake: null, or {sun, sky, samples}: the direction towards the sun, linear light of the sky (red, green, blue), rays
  // to the sky per voxel. budget: null, or the most words that the memory may have; it gives up what is seen least.
  voxelize(scene, { depth = 7, fill = "auto", colours = COLOURS, bake = null, budget = null } = {}) {
    if (!Number.isInteger(depth) || depth < 1 || depth > DEPTH_LIMIT)
      throw new VoxrtError(`depth must be 1 … 16, not ${depth}`);
    if (!FILLS.includes(fill)) throw new VoxrtError(`fill must be ${FILLS.join(", ")}, not ${fill}`);
    const { wasm } = this;
    return this.guard(() => {
      wasm.vx_scene_begin();
      for (const {
        name,
        colour: [red, green, blue],
        mirror = false,
        authored = true,
      } of scene.materials)
        this.text(name, (at) =>
          this.checked(wasm.vx_material(at, (red << 16) | (green << 8) | blue, mirror, authored)),
        );
      const appearances = new Map();
      const images = new Map();
      for (const mesh of scene.meshes) {
        const [vertices, triangles] = [mesh.positions.length / 3, mesh.triangles.length / 3];
        this.with(Float64Array, mesh.positions, (at) =>
          this.with(Int32Array, mesh.triangles, (corners) =>
            this.with(Uint8Array, mesh.materials, (ids) =>
              this.checked(wasm.vx_mesh(at, vertices, corners, triangles, ids)),
            ),
          ),
        );
        if (bake && mesh.normals)
          this.with(Float64Array, mesh.normals.directions, (at) =>
            this.with(Int32Array, mesh.normals.rows, (rows) =>
              this.checked(wasm.vx_normals(at, mesh.normals.directions.length / 3, rows)),
            ),
          );
        if (!mesh.surface) continue;
        const { entries, rows, uv, colours: light } = mesh.surface;
        const numbers = entries.map((entry) => {
          if (!appearances.has(entry)) appearances.set(entry, this.#appearance(entry, images));
          return appearances.get(entry);
        });
        this.with(Int32Array, numbers, (list) =>
          this.with(Int32Array, rows, (of) =>
            this.with(Float64Array, uv, (places) =>
              this.with(Float32Array, light, (tints) =>
                this.checked(wasm.vx_surface(list, numbers.length, of, places, tints)),
              ),
            ),
          ),
        );
      }
      for (const { name, mesh, transform } of scene.objects)
        this.with(Float64Array, transform, (at) =>
          this.text(name, (text) => this.checked(wasm.vx_object(mesh, at, text))),
        );
      const transparent = this.checked(wasm.vx_scene_end());
      this.checked(wasm.vx_voxelize(depth, FILLS.indexOf(fill), colours));
      const baked = bake && this.#bake(bake);
      const fitted = budget && this.#fit(budget);
      if (baked && fitted) baked.colours = fitted.colours;
      const words = this.view(Uint32Array, wasm.vx_words(), wasm.vx_word_count()).slice();
      const voxels = this.view(BigInt64Array, wasm.vx_object_voxels(), wasm.vx_object_count()).slice();
      const objects = Array.from(voxels, (count, i) => ({
        name: this.string(wasm.vx_object_name(i)),
        mode: this.string(wasm.vx_object_mode(i)),
        voxels: Number(count),
      }));
      const materials = Array.from({ length: wasm.vx_material_count() }, (_, id) => {
        const look = wasm.vx_material_look(id);
        return {
          name: this.string(wasm.vx_material_name(id)),
          colour: [(look >> 16) & 255, (look >> 8) & 255, look & 255],
          mirror: Boolean(look & (1 << 24)),
          authored: Boolean(look & (1 << 25)),
        };
      });
      const warnings = transparent
        ? [{ kind: "transparent", message: "fully transparent faces were left out", count: transparent }]
        : [];
      for (let i = 0; i < wasm.vx_warning_count(); i++)
        warnings.push({
          kind: this.string(wasm.vx_warning_kind(i)),
          message: this.string(wasm.vx_warning_message(i)),
          count: wasm.vx_warning_objects(i),
        });
      const grid = { origin: [...this.view(Float64Array, wasm.vx_origin(), 3)], voxelSize: wasm.vx_voxel_size() };
      wasm.vx_scene_begin();
      return { words, depth, grid, materials, objects, warnings, baked, fitted };
    });
  }

  // Put light into the colours. Returns what the manifest says of it.
  #bake({ sun, sky, samples }) {
    const { wasm } = this;
    const wordsBefore = wasm.vx_word_count();
    const voxels = this.with(Float64Array, sun, (towards) =>
      this.with(Float64Array, sky, (light) => this.checked(wasm.vx_bake(towards, light, samples))),
    );
    return { sun, sky, samples, voxels, colours: BAKED_COLOURS, wordsBefore, words: wasm.vx_word_count() };
  }

  // Make the memory fit. Returns what was given up.
  #fit(words) {
    if (!Number.isInteger(words) || words < 1 || words > 2 ** 32 - 1)
      throw new VoxrtError(`budget must be a number of words, 1 or more, not ${words}`);
    const wordsBefore = this.wasm.vx_word_count();
    this.checked(this.wasm.vx_fit(words));
    const [wordsShared, surface, changed, appeared, recoloured, colours] = this.view(
      Float64Array,
      this.wasm.vx_fit_figures(),
      6,
    );
    return { words, wordsBefore, wordsShared, surface, changed, appeared, recoloured, colours };
  }

  #appearance({ name, factor = [1, 1, 1, 1], texture = null, cutoff = 0, mirror = false }, images) {
    const { image, wrap = ["repeat", "repeat"], nearest = false } = texture ?? {};
    if (image && !images.has(image)) images.set(image, this.wasm.vx_image(this.copy(Uint8Array, image.pixels)));
    const [u, v] = wrap.map((one) => WRAPS.indexOf(one));
    return this.text(name, (text) =>
      this.with(Float64Array, factor, (light) =>
        this.checked(
          this.wasm.vx_appearance(
            text,
            light,
            image ? images.get(image) : 0,
            image?.width ?? 0,
            image?.height ?? 0,
            u,
            v,
            nearest,
            cutoff,
            mirror,
          ),
        ),
      ),
    );
  }

  // The words of voxels given one by one: x, y, z from 0 up to 2^depth, and a material, 1 … 255, each. Where a place
  // repeats, the first counts.
  fromPoints(places, materials, depth) {
    return this.guard(() =>
      this.with(Int32Array, places, (at) =>
        this.with(Uint8Array, materials, (ids) => {
          const count = this.checked(this.wasm.vx_points(at, ids, materials.length, depth));
          return this.view(Uint32Array, this.wasm.vx_points_words(), count).slice();
        }),
      ),
    );
  }

  // Take the words of an octree memory (Uint32Array), which are checked.
  setMemory(words, depth) {
    this.guard(() => this.with(Uint32Array, words, (at) => this.checked(this.wasm.vx_memory(at, words.length, depth))));
  }

  // The least depth of the world that words (Uint32Array) describe.
  depthOf(words) {
    return this.guard(() => this.with(Uint32Array, words, (at) => this.checked(this.wasm.vx_depth(at, words.length))));
  }

  // The least number of levels by which the memory must be coarser to have at most so many words.
  levelThatFits(words) {
    return this.guard(() => this.checked(this.wasm.vx_level_that_fits(words)));
  }

  // How hits are coloured. materials: sRGB triples by id, entry 0 the background. mirrors: ids. faces: six brightnesses, or
  // null for the angle. light: null, or {position in 1/16 voxel, ambient}.
  shade({ materials, mirrors = [], bounces = 0, flat = false, faces = FACES, light = null }) {
    const table = new Uint8Array(768);
    materials.forEach((colour, id) => table.set(colour, 3 * id));
    const flags = new Uint8Array(256);
    for (const id of mirrors) flags[id] = 1;
    this.guard(() =>
      this.with(Uint8Array, table, (colours) =>
        this.with(Uint8Array, flags, (mirrored) =>
          this.with(Uint8Array, faces ?? [], (brightness) =>
            this.with(Int32Array, light?.position ?? [], (place) =>
              this.wasm.vx_shading(
                colours,
                mirrored,
                bounces,
                flat,
                faces && !flat ? brightness : 0,
                light ? place : 0,
                light?.ambient ?? 0,
              ),
            ),
          ),
        ),
      ),
    );
  }

  // Render a frame, or its rows of tiles `first` up to and without `end`; a tile is 16 pixels high. camera: {position in
  // 1/16 voxel, look, right, up}. Returns copies: colour (RGB), material and face, from row `top` on, and wordsRead.
  render(camera, [width, height], first = 0, end = this.tileRows(height)) {
    return this.guard(() => {
      const wordsRead = this.#trace(camera, width, height, first, end);
      const [top, bottom] = [16 * first, Math.min(16 * end, height)];
      const part = (at, bytes) =>
        this.view(Uint8Array, at + top * width * bytes, (bottom - top) * width * bytes).slice();
      return {
        top,
        wordsRead,
        colour: part(this.wasm.vx_colour(), 3),
        material: part(this.wasm.vx_frame_material(), 1),
        face: part(this.wasm.vx_frame_face(), 1),
      };
    });
  }

  // The same for a canvas: {top, pixels}, RGBA as ImageData takes it. `buffer`: an ArrayBuffer for them, which is used if
  // it has the right size.
  renderImage(camera, [width, height], first = 0, end = this.tileRows(height), buffer = null) {
    return this.guard(() => {
      this.#trace(camera, width, height, first, end);
      const top = 16 * first;
      const count = (Math.min(16 * end, height) - top) * width;
      const pixels = new Uint32Array(buffer?.byteLength === 4 * count ? buffer : count);
      opaque(this.view(Uint8Array, this.wasm.vx_colour() + 3 * top * width, 3 * count), pixels);
      return { top, pixels: new Uint8ClampedArray(pixels.buffer) };
    });
  }

  #trace({ position, look, right, up }, width, height, first, end) {
    return this.with(Int32Array, [...position, ...look, ...right, ...up], (at) =>
      this.checked(this.wasm.vx_render(at, width, height, first, end)),
    );
  }

  tileRows(height) {
    return this.wasm.vx_tile_rows(height);
  }

  // Follow one ray: each word that it reads, and what it hits. origin: 1/16 voxel; direction: below 2^20.
  follow(origin, direction) {
    return this.guard(() => {
      const count = this.with(Int32Array, origin, (from) =>
        this.with(Int32Array, direction, (to) => this.checked(this.wasm.vx_follow(from, to))),
      );
      const all = this.view(Int32Array, this.wasm.vx_readings(), 7 * count + 5).slice();
      const readings = Array.from({ length: count }, (_, i) => {
        const [address, word, level, x, y, z, axis] = all.subarray(7 * i, 7 * i + 7);
        return { address: address >>> 0, word: word >>> 0, level, corner: [x, y, z], axis };
      });
      const [material, face, x, y, z] = all.subarray(7 * count);
      return { readings, material, face, cell: material ? [x, y, z] : null };
    });
  }

  // The voxels of the memory by material: 256 numbers, entry 0 the empty ones.
  voxels() {
    return this.guard(() => [...this.view(Float64Array, this.wasm.vx_voxel_counts(), 256)]);
  }

  // Cubes that hold all that is solid, no finer than 1/64 of the world: [x, y, z of the lowest corner, side] each.
  outline() {
    return this.guard(() => {
      const count = this.checked(this.wasm.vx_outline());
      return this.view(Int32Array, this.wasm.vx_outline_leaves(), 4 * count).slice();
    });
  }

  // Linear light, 0 … 1, as sRGB, 0 … 255.
  srgb(linear) {
    return this.wasm.vx_srgb(linear);
  }

  // sRGB, 0 … 255, as linear light.
  linear(code) {
    return this.wasm.vx_linear(code);
  }
}

const ALPHA = 0xff000000;

// RGB as opaque RGBA. Four pixels are three words of one and four of the other: WebAssembly and every browser are
// little-endian. Rows of tiles start at a multiple of four bytes.
function opaque(rgb, rgba) {
  const fours = rgba.length >> 2;
  const words = new Uint32Array(rgb.buffer, rgb.byteOffset, 3 * fours);
  for (let i = 0, from = 0, to = 0; i < fours; i++, from += 3, to += 4) {
    const [a, b, c] = [words[from], words[from + 1], words[from + 2]];
    rgba[to] = a | ALPHA;
    rgba[to + 1] = (a >>> 24) | ((b & 0xffff) << 8) | ALPHA;
    rgba[to + 2] = (b >>> 16) | ((c & 0xff) << 16) | ALPHA;
    rgba[to + 3] = (c >>> 8) | ALPHA;
  }
  for (let to = 4 * fours; to < rgba.length; to++)
    rgba[to] = rgb[3 * to] | (rgb[3 * to + 1] << 8) | (rgb[3 * to + 2] << 16) | ALPHA;
}
