// The colour and opacity of USD materials, as voxrt build reads them (voxelize/formats/usd/shading.py).

import { OPAQUE_FROM } from "../voxrt/opacity.js";
import { attributeOf, fieldsOf, targetsOf } from "./stage.js";
/** @import { Wrap } from "../voxrt/voxrt.js" @import { Warn } from "../voxrt/warnings.js" */
/** @import { Numbers, Value } from "./stage.js" @import { Composer } from "./three_private.js" */

/** @typedef {{ primvar: string, turn: number, scale: number[], offset: number[] }} Coordinates */

/** A texture; `point` are the coordinates where none are connected. @typedef {{ file: string, channel: string, raw:
 * boolean, wrap: Wrap[], factor: number[], bias: number[], point: number[] | null }} Image */

/** @typedef {Image & Coordinates} Texture */

/** The colour and opacity of a material. `id`: equal shadings are one; `name`: null for no colour; `colour`: linear;
 * null where the author gave none; `primvar`: that gives the colour. @typedef {{ id: number, name: string | null,
 * colour: number[] | null, opacity: number, cutoff: number, image: Texture | null, alpha: Texture | null, primvar:
 * string | null }} Shading */

/** @typedef {Omit<Shading, "id">} Unnumbered */
/** @typedef {{ value?: number[] | null, image?: Texture, primvar?: string }} Input */
/** @typedef {{ node: string, output: string, value?: undefined } | { node?: undefined, value: Value }} Producer */
const FALLBACK_DIFFUSE = [0.18, 0.18, 0.18]; // UsdPreviewSurface's own
const COLOUR_INPUTS =
  "diffuseColor base_color baseColor diffuse_color_constant diffuse_reflection_color diffuse_color color".split(" ");
const EMISSION_INPUTS = "emissiveColor emission_color emission emissive_color".split(" ");
const CONTEXTS = ["", "mtlx:", "mdl:", "ri:", "glslfx:"];
/** @type {Record<string, Wrap>} */
const WRAPS = { repeat: "repeat", mirror: "mirror", clamp: "clamp", black: "clamp" };

/** @type {Unnumbered} */ export const noShading = {
  name: null,
  colour: null,
  opacity: 1,
  cutoff: OPAQUE_FROM,
  image: null,
  alpha: null,
  primvar: null,
};

/** @param {Composer} composer @param {string} material @param {Warn} warn */
export function readShading(composer, material, warn) {
  const plain = { ...noShading, name: material.slice(material.lastIndexOf("/") + 1) };
  const producers = CONTEXTS.map((context) => producer(composer, material, `outputs:${context}surface`));
  const shader = producers.find((found) => found?.node)?.node;
  if (!shader) {
    warn("material-colour", "materials without a supported surface shader got the default colour");
    return plain;
  }
  /** @param {string[]} names */ const read = (names) => inputOf(composer, shader, names, warn);
  const [threshold, opacity, reflected] = [read(["opacityThreshold"]), read(["opacity"]), read(COLOUR_INPUTS)];
  const emitted = isBlack(reflected) ? read(EMISSION_INPUTS) : null;
  const colour = emitted && !isBlack(emitted) ? emitted : reflected; // what reflects nothing shows what it emits
  const isPreview = attributeOf(composer, shader, "info:id") === "UsdPreviewSurface";
  const bare = !colour || (!colour.value && !colour.image && !colour.primvar);
  if (!colour && !isPreview) warn("material-colour", "materials whose shader has no colour got the default colour");
  return {
    ...plain,
    colour: colour?.value ?? (bare && isPreview ? FALLBACK_DIFFUSE : null),
    opacity: opacity?.value ? opacity.value[0] : 1,
    cutoff: threshold?.value?.[0] || OPAQUE_FROM,
    image: colour?.image ?? null,
    alpha: opacity?.image ?? null,
    primvar: colour?.primvar ?? null,
  };
}

/** Whether it is one colour that reflects nothing. @param {Input | null | undefined} input */
const isBlack = (input) => Boolean(input?.value && !input.image && !input.primvar && Math.max(...input.value) <= 0);

/** @param {Composer} composer @param {string} path */
const isShader = (composer, path) => composer.specsByPath[path]?.fields.typeName === "Shader";

/** What gives a property its value; null for nothing. @param {Composer} composer @param {string} prim @param
 * {string} name @param {Set<string>} [seen] @returns {Producer | null} */
function producer(composer, prim, name, seen = new Set()) {
  const fields = fieldsOf(composer, prim, name);
  if (!fields || seen.has(`${prim}.${name}`)) return null;
  seen.add(`${prim}.${name}`);
  for (const target of targetsOf(fields.connectionPaths, prim)) {
    const at = target.indexOf(".");
    const [node, property] = [target.slice(0, at), target.slice(at + 1)];
    if (isShader(composer, node) && property.startsWith("outputs:"))
      return { node, output: property.slice("outputs:".length) };
    const found = producer(composer, node, property, seen);
    if (found) return found;
  }
  const value = attributeOf(composer, prim, name);
  return value === null ? null : { value };
}

/** @param {Composer} composer @param {string} node @param {string} name */
const input = (composer, node, name) => producer(composer, node, `inputs:${name}`);
/** @param {Composer} composer @param {string} node @param {string} name */
const constant = (composer, node, name) => input(composer, node, name)?.value ?? null;
/** @param {Composer} composer @param {string} node */
const idOf = (composer, node) => attributeOf(composer, node, "info:id")?.toString();

/** The first of some inputs that says anything. @param {Composer} composer @param {string} shader @param {string[]}
 * names @param {Warn} warn */
function inputOf(composer, shader, names, warn) {
  for (const name of names) {
    const found = input(composer, shader, name);
    if (found?.node !== undefined) return networkOf(composer, found, warn);
    const value = colourOf(found?.value ?? null);
    if (value) return { value };
  }
  return null;
}

/** @param {Composer} composer @param {{ node: string, output: string }} producer @param {Warn} warn @returns {Input} */
function networkOf(composer, { node, output }, warn) {
  const kind = idOf(composer, node);
  const value = colourOf(constant(composer, node, "fallback"));
  if (kind === "UsdUVTexture") return { value, image: textureOf(composer, node, output, warn) };
  if (kind?.startsWith("UsdPrimvarReader_float3"))
    return { value, primvar: String(constant(composer, node, "varname") ?? "") };
  warn("shader", `shader nodes ${kind ?? "without an id"} are not supported; the default colour was used`);
  return {};
}

/** @param {Composer} composer @param {string} node @param {string} channel @param {Warn} warn */
function textureOf(composer, node, channel, warn) {
  /** @param {string} name */ const read = (name) => constant(composer, node, name);
  const wraps = ["wrapS", "wrapT"].map((name) => String(read(name) ?? "repeat"));
  if (wraps.includes("black"))
    warn("texture", "textures that are black beyond their edges were continued with their edges' colours");
  return {
    file: String(read("file") ?? "").replace(/^@+|@+$/g, ""),
    channel,
    raw: read("sourceColorSpace") === "raw",
    wrap: wraps.map((wrap) => WRAPS[wrap] ?? "repeat"),
    ...coordinatesOf(composer, node, warn),
    factor: numbers(read("scale"), 4) ?? [1, 1, 1, 1],
    bias: numbers(read("bias"), 4) ?? [0, 0, 0, 0],
    point: input(composer, node, "st")?.node !== undefined ? null : (numbers(read("st"), 2) ?? [0, 0]),
  };
}

/** @param {Composer} composer @param {string} node @param {Warn} warn */ function coordinatesOf(composer, node, warn) {
  const made = { primvar: "st", turn: 0, scale: [1, 1], offset: [0, 0] };
  let source = input(composer, node, "st")?.node;
  if (source && idOf(composer, source) === "UsdTransform2d") {
    [made.turn] = numbers(constant(composer, source, "rotation"), 1) ?? [0];
    made.scale = numbers(constant(composer, source, "scale"), 2) ?? made.scale;
    made.offset = numbers(constant(composer, source, "translation"), 2) ?? made.offset;
    source = input(composer, source, "in")?.node;
  }
  if (!source) return made;
  const kind = String(idOf(composer, source) ?? "");
  if (kind.startsWith("UsdPrimvarReader_float2"))
    return { ...made, primvar: String(constant(composer, source, "varname") || "st") };
  warn("shader", `shader nodes ${kind || "None"} are not supported; coordinates 'st' were used`);
  return made;
}

/** The first numbers of a value; null where it has fewer. @param {Value | null} value @param {number} count */
function numbers(value, count) {
  const flat = /** @type {unknown[]} */ ([value ?? []].flat());
  const found = flat.flatMap((one) =>
    ArrayBuffer.isView(one) ? Array.from(/** @type {Float64Array} */ (one)) : [one],
  );
  const parts = found.slice(0, count).filter((one) => typeof one === "number");
  return parts.length === count ? parts.map(Math.fround) : null;
}

/** @param {Value | null} value */ function colourOf(value) {
  if (typeof value === "number") return [value, value, value].map(Math.fround);
  return numbers(value, 3);
}
