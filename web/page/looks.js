// How the page colours hits: what a memory says of it, and what the user has chosen.

import { PLAIN } from "./memory.js";
import { BACKGROUND, FACES } from "./voxrt/voxrt.js";
/** @import { Look } from "./light.js" @import { Lighting, Memory } from "./memory.js" */
/** @import { Look as Shading } from "./voxrt/voxrt.js" */

const LAMP = [1.4, 1.9, 1.1]; // sides of the world
const BOUNCES = 3;
const AROUND = [236, 240, 244]; // as the light background of previews
const START = { shading: "faces", features: [], light: [0, 0, 0] };
/** @type {Look} */
export const FIRST_LOOK = { ...START, ambient: PLAIN.ambient, bounces: BOUNCES, background: AROUND };

/** The look of a memory that follows another one. A memory is shown as it says. What the user chooses then stays,
 * until a memory says something else. @param {Look} look that of the page now @param {Memory} memory @param {Memory
 * | null} old @param {boolean} first whether the memory is of another file */
export function nextLook(look, memory, old, first) {
  const { lighting } = memory;
  const changes = (first && lighting) || !same(lighting, old?.lighting);
  const [background, oldBackground] = [ownBackground(memory), ownBackground(old)];
  return {
    ...look,
    ...(changes && lookOf(lighting)),
    ...((background || oldBackground) && { background: background ?? AROUND }),
    light: lighting?.on ? lighting.position : LAMP.map((part) => Math.round(part * 16 * 2 ** memory.depth)),
  };
}

/** @param {unknown} one @param {unknown} other */
const same = (one, other) => JSON.stringify(one ?? null) === JSON.stringify(other ?? null);

/** @param {Lighting | null | undefined} lighting */ function lookOf(lighting) {
  const { flat, faces, ambient, on, bounces } = lighting ?? PLAIN;
  const features = [...(on ? ["light"] : []), ...(bounces ? ["mirrors"] : [])];
  return { shading: flat ? "flat" : faces ? "faces" : "report", ambient, bounces: bounces || BOUNCES, features };
}

/** The background that a memory has of its own, or null. @param {Memory | null} memory */
const ownBackground = (memory) =>
  memory?.manifest && !same(memory.materials[0].colour, BACKGROUND) ? [...memory.materials[0].colour] : null;

/** How workers colour hits. @param {Memory} memory @param {Look} look */
export function shadingOf({ materials, lighting }, look) {
  return {
    materials: materials.map(({ colour }, id) => (id ? colour : look.background)),
    mirrors: materials.flatMap(({ mirror }, id) => (mirror ? [id] : [])),
    flat: look.shading === "flat",
    faces: look.shading === "faces" ? (lighting?.faces ?? FACES) : null,
    light: look.features.includes("light") ? { position: look.light, ambient: look.ambient } : null,
    bounces: look.features.includes("mirrors") ? look.bounces : 0,
  };
}
