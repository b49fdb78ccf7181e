// The colour and opacity of USD materials, as voxrt build reads them (voxelize/formats/usd/shading.py).
//
// A shading is {name, colour, opacity, cutoff, image, alpha, primvar}: colour is linear, null where the author gave none;
// image and alpha are textures, primvar the name of what gives the colour; each may be null. name is null for no colour.

import { fieldsOf, targetsOf, valueOf } from "./stage.js";

export const BLEND_CUTOFF = 0.5;
const FALLBACK_DIFFUSE = [0.18, 0.18, 0.18]; // UsdPreviewSurface's own
const COLOUR_INPUTS = [
  "diffuseColor",
  "base_color",
  "baseColor",
  "diffuse_color_constant",
  "diffuse_reflection_color",
  "diffuse_color",
  "color",
];
const CONTEXTS = ["", "mtlx:", "mdl:", "ri:", "glslfx:"];
const WRAPS = { repeat: "repeat", mirror: "mirror", clamp: "clamp", black: "clamp" };

export const noShading = {
  name: null,
  colour: null,
  opacity: 1,
  cutoff: BLEND_CUTOFF,
  image: null,
  alpha: null,
  primvar: null,
};

export function readShading(composer, material, warn) {
  const plain = { ...noShading, name: material.slice(material.lastIndexOf("/") + 1) };
  const shader = CONTEXTS.map((context) => producer(composer, material, `outputs:${context}surface`)).find(
    (found) => found?.node,
  )?.node;
  if (!shader) {
    warn("material-colour", "materials without a supported surface shader got the default colour");
    return plain;
  }
  const read = (names) => inputOf(composer, shader, names, warn);
  const [threshold, opacity, colour] = [read(["opacityThreshold"]), read(["opacity"]), read(COLOUR_INPUTS)];
  const isPreview = valueOf(composer, shader, "info:id") === "UsdPreviewSurface";
  const bare = !colour || (!colour.value && !colour.image && !colour.primvar);
  if (!colour && !isPreview) warn("material-colour", "materials whose shader has no colour got the default colour");
  return {
    ...plain,
    colour: colour?.value ?? (bare && isPreview ? FALLBACK_DIFFUSE : null),
    opacity: opacity?.value ? opacity.value[0] : 1,
    cutoff: (threshold?.value && threshold.value[0]) || BLEND_CUTOFF,
    image: colour?.image ?? null,
    alpha: opacity?.image ?? null,
    primvar: colour?.primvar ?? null,
  };
}

const isShader = (composer, path) => composer.specsByPath[path]?.fields.typeName === "Shader";

// What gives a property its value: {node, output}, a shader and its output; or {value}; null for nothing.
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
  const value = valueOf(composer, prim, name);
  return value === null ? null : { value, type: fields.typeName };
}

const input = (composer, node, name) => producer(composer, node, `inputs:${name}`);
const constant = (composer, node, name) => input(composer, node, name)?.value ?? null;
const idOf = (composer, node) => valueOf(composer, node, "info:id");

// {value, image, primvar} of the first of some inputs that says anything.
function inputOf(composer, shader, names, warn) {
  for (const name of names) {
    const found = input(composer, shader, name);
    if (found?.node) return networkOf(composer, found, warn);
    const value = colourOf(found?.value);
    if (value) return { value };
  }
  return null;
}

function networkOf(composer, { node, output }, warn) {
  const kind = idOf(composer, node);
  const value = colourOf(constant(composer, node, "fallback"));
  if (kind === "UsdUVTexture") return { value, image: { ...imageSource(composer, node, warn), channel: output } };
  if (kind?.startsWith("UsdPrimvarReader_float3"))
    return { value, primvar: String(constant(composer, node, "varname") ?? "") };
  warn("shader", `shader nodes ${kind ?? "without an id"} are not supported; the default colour was used`);
  return {};
}

// {file, raw, wrap, primvar, turn, scale, offset, factor, bias, point}: point are the coordinates where none are connected.
function imageSource(composer, node, warn) {
  const read = (name) => constant(composer, node, name);
  const wraps = ["wrapS", "wrapT"].map((name) => String(read(name) ?? "repeat"));
  if (wraps.includes("black"))
    warn("texture", "textures that are black beyond their edges were continued with their edges' colours");
  return {
    file: String(read("file") ?? "").replace(/^@+|@+$/g, ""),
    raw: read("sourceColorSpace") === "raw",
    wrap: wraps.map((wrap) => WRAPS[wrap] ?? "repeat"),
    ...coordinatesOf(composer, node, warn),
    factor: numbers(read("scale"), 4) ?? [1, 1, 1, 1],
    bias: numbers(read("bias"), 4) ?? [0, 0, 0, 0],
    point: input(composer, node, "st")?.node ? null : (numbers(read("st"), 2) ?? [0, 0]),
  };
}

function coordinatesOf(composer, node, warn) {
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

// The first numbers of a value, in single precision; null where it has fewer.
function numbers(value, count) {
  const found = [value ?? []]
    .flat()
    .flatMap((one) => (ArrayBuffer.isView(one) ? [...one] : [one]))
    .slice(0, count);
  return found.length === count && found.every((one) => typeof one === "number") ? found.map(Math.fround) : null;
}

function colourOf(value) {
  if (typeof value === "number") return [value, value, value].map(Math.fround);
  return numbers(value, 3);
}
