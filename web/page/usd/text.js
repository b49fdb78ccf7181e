// USD files of text: what the parser of three.js' loader leaves out of them, or takes for something else.

const SPECIFIER = Symbol("specifier"); // 0 for def, 1 for over, 2 for class
const SET = /^variantSet\s+"([^"]+)"/;
const VARIANT = 10; // a type of specs

/** @import { Fields, Specs } from "./stage.js" */
/** @import { Data, MethodsOf, SpecTypes, TextParser } from "./three_private.js" */

/** @param {unknown} value */ const isData = (value) => typeof value === "object" && value !== null;

/** The symbols of values that have notes in parentheses. @param {Data} data */
const noteSymbols = (data) => Object.getOwnPropertySymbols(data).filter((symbol) => symbol !== SPECIFIER);

/** @type {MethodsOf<TextParser>} */ export const textMethods = (kept) => {
  /** @type {Data} the text that was parsed last */ let parsed = {};
  return {
    _preprocess(text) {
      return kept._preprocess.call(this, text).split("\n").flatMap(statements).join("\n");
    },
    parseText(text) {
      parsed = asDefinitions(kept.parseText.call(this, text));
      return parsed;
    },
    parseData(text) {
      const made = kept.parseData.call(this, text);
      const { fields } = made.specsByPath["/"];
      const header = parsed["#usda 1.0"];
      if (!isData(header)) return made;
      const { startTimeCode, endTimeCode, subLayers } = header;
      if (startTimeCode !== undefined) fields.startTimeCode = Number(startTimeCode);
      if (endTimeCode !== undefined) fields.endTimeCode = Number(endTimeCode);
      if (subLayers) fields.subLayers = [/** @type {string} */ (subLayers)];
      return made;
    },
    _extractPrimData(data, path, fields, specs, types) {
      if (!isData(data)) return;
      readLists(data, fields);
      kept._extractPrimData.call(this, plainData(data), path, fields, specs, types);
      const keys = Object.keys(data).filter((key) => SET.test(key));
      if (keys.length) fields.variantSetChildren = keys.map(setName);
      for (const key of keys)
        for (const [name, variant] of Object.entries(data[key]))
          addVariant(this, variant, `${path}/{${setName(key)}=${name.replace(/"/g, "")}}`, specs, types);
      readNotes(data, path, specs);
    },
  };
};

/** @param {string} key */ const setName = (key) => SET.exec(key)?.[1] ?? "";

/** What the parser takes of a prim. @param {Data} data */
function plainData(data) {
  const plain = withoutPrefixes(data);
  for (const symbol of noteSymbols(data)) plain[symbol] = withoutPrefixes(/** @type {Data} */ (data[symbol]));
  const references = keyOf(data, /^(add |append )?references$/);
  if (references) plain["prepend references"] ??= data[references];
  const payload = keyOf(data, /^(prepend |add |append )payload$/);
  if (payload) plain.payload ??= data[payload];
  return plain;
}

/** @param {Data} data @param {RegExp} pattern */
const keyOf = (data, pattern) => Object.keys(data).find((key) => pattern.test(key));

/** Read what the parser leaves out of a prim. @param {Data} data @param {Fields} fields */
function readLists(data, fields) {
  fields.specifier = Number(data[SPECIFIER] ?? 0);
  if (data.active === "false") fields.active = false;
  const inherits = keyOf(data, /^(\w+ )?inherits$/);
  if (inherits) fields.inheritPaths = [/** @type {string} */ (data[inherits])];
  const specializes = keyOf(data, /^(\w+ )?specializes$/);
  if (specializes) fields.specializes = [/** @type {string} */ (data[specializes])];
  const keys = Object.keys(data).filter((key) => /^(?!delete )(\w+ )?apiSchemas$/.test(key));
  const schemas = keys.flatMap((key) => String(data[key]).match(/[\w:]+/g) ?? []);
  if (schemas.length) fields.apiSchemas = schemas;
}

/** Read the notes behind attributes. @param {Data} data @param {string} path @param {Specs} specs */
function readNotes(data, path, specs) {
  const [symbol] = noteSymbols(data);
  const notes = symbol ? withoutPrefixes(/** @type {Data} */ (data[symbol])) : {};
  for (const [key, note] of Object.entries(notes)) {
    const spec = specs[`${path}.${key.replace(/^uniform\s+/, "").split(/\s+/)[1]}`];
    if (!spec || !isData(note)) continue;
    if (note.interpolation) spec.fields.interpolation = String(note.interpolation).replace(/"/g, "");
    if (note.elementSize) spec.fields.elementSize = Number(note.elementSize);
  }
}

/** Add the specs of a variant, or of a prim in one. @param {TextParser} parser @param {Data | string} data @param
 * {string} path @param {Specs} specs @param {SpecTypes} types */
function addVariant(parser, data, path, specs, types, typeName = "") {
  if (!isData(data)) return;
  /** @type {Fields} */ const fields = { typeName };
  specs[path] = { specType: typeName || !path.endsWith("}") ? types.Prim : VARIANT, fields };
  parser._extractPrimData(data, path, fields, specs, types);
  for (const key of Object.keys(data)) {
    const [, kind, name] = /^def\s+(?:(\w+)\s+)?"([^"]+)"$/.exec(key) ?? [];
    if (!name) continue;
    fields.primChildren = [...(fields.primChildren ?? []), name];
    addVariant(parser, data[key], `${path}/${name}`, specs, types, kind);
  }
}

/** The parser knows prims that begin with "def" alone. @param {Data} data */
function asDefinitions(data) {
  /** @type {Data} */ const made = {};
  for (const symbol of Object.getOwnPropertySymbols(data)) made[symbol] = data[symbol];
  for (const [key, value] of Object.entries(data)) {
    const [, word] = /^(def|over|class)\b/.exec(key) ?? [];
    if (!word) {
      made[key] = isData(value) && (SET.test(key) || key.startsWith('"')) ? asDefinitions(value) : value;
    } else if (isData(value)) {
      const part = asDefinitions(value);
      part[SPECIFIER] = String(["def", "over", "class"].indexOf(word));
      made[key.replace(word, "def")] = part;
    }
  }
  return made;
}

/** "custom rel a" is "rel a", "prepend token b.connect" is "token b.connect". @param {Data} data @returns {Data} */
function withoutPrefixes(data) {
  const entries = Object.entries(data).filter(([, value]) => value !== "" && value !== "None");
  return Object.fromEntries(
    entries.map(([key, value]) => [key.replace(/^(?:(?:custom|varying|prepend|append|add)\s+)+(?=\S+\s)/, ""), value]),
  );
}

/** @param {string[]} texts */ const trimmed = (texts) => texts.map((one) => one.trim()).filter(Boolean);

/** The parser wants one statement per line, as USD itself writes them. @param {string} line @returns {string[]} */
function statements(line) {
  const body = /^((?:def|over|class)\b[^{]*)\{\s*(\S.*)$/.exec(line);
  if (body) {
    const inside = body[2].endsWith("}") ? [...body[2].slice(0, -1).split(";"), "}"] : [body[2]];
    return [...statements(body[1].trim()), "{", ...trimmed(inside).flatMap(statements)];
  }
  if (/^[{)]\s*\S/.test(line)) return [line[0], ...statements(line.slice(1).trim())];
  if (/^[}\s]+$/.test(line)) return [...line.replace(/\s/g, "")];
  if (/,\s*\]/.test(line)) return statements(line.replace(/,\s*\]/g, "]"));
  if (line.endsWith("(") && line.includes(":") && !line.includes("=")) return [`${line.slice(0, -1)} = (`]; // an attribute without a value
  if (!line.endsWith(")")) return [line];
  const at = line.lastIndexOf("(");
  const inside = line.slice(at + 1, -1);
  const prim = /^(?:def|over|class)\b/.test(line);
  if (at < 1 || !/^\s*(?:\w+\s+)?\w+\s*=/.test(inside) || !(prim || line.slice(0, at).includes("="))) return [line];
  return [`${line.slice(0, at).trim()} (`, ...trimmed(inside.split(";")), ")"];
}
