// USD files of text: what the parser of three.js' loader leaves out of them, or takes for something else.

const SPECIFIER = Symbol("specifier"); // 0 for def, 1 for over, 2 for class
const SET = /^variantSet\s+"([^"]+)"/;
const VARIANT = 10; // a type of specs

// Methods for USDAParser. `kept`: its own ones.
export const textMethods = (kept) => ({
  _preprocess(text) {
    return kept._preprocess.call(this, text).split("\n").flatMap(statements).join("\n");
  },
  parseText(text) {
    this.parsed = asDefinitions(kept.parseText.call(this, text));
    return this.parsed;
  },
  parseData(text) {
    const made = kept.parseData.call(this, text);
    const [{ fields }, header] = [made.specsByPath["/"], this.parsed["#usda 1.0"] ?? {}];
    for (const name of ["startTimeCode", "endTimeCode"])
      if (header[name] !== undefined) fields[name] = Number(header[name]);
    if (header.subLayers) fields.subLayers = [header.subLayers];
    return made;
  },
  _extractPrimData(data, path, fields, specs, types) {
    if (!data || typeof data !== "object") return;
    const notes = data[Object.getOwnPropertySymbols(data).find((symbol) => symbol !== SPECIFIER)] ?? {};
    const plain = withoutPrefixes(data);
    for (const symbol of Object.getOwnPropertySymbols(data))
      if (symbol !== SPECIFIER) plain[symbol] = withoutPrefixes(data[symbol]);
    const has = (pattern) => Object.keys(data).find((key) => pattern.test(key));
    for (const [name, pattern] of [
      ["prepend references", /^(add |append )?references$/],
      ["payload", /^(prepend |add |append )payload$/],
    ])
      if (has(pattern)) plain[name] ??= data[has(pattern)];
    fields.specifier = data[SPECIFIER] ?? 0;
    if (data.active === "false") fields.active = false;
    if (has(/^(\w+ )?inherits$/)) fields.inheritPaths = [data[has(/^(\w+ )?inherits$/)]];
    if (has(/^(\w+ )?specializes$/)) fields.specializes = [data[has(/^(\w+ )?specializes$/)]];
    const schemas = Object.keys(data)
      .filter((key) => /^(?!delete )(\w+ )?apiSchemas$/.test(key))
      .flatMap((key) => String(data[key]).match(/[\w:]+/g) ?? []);
    if (schemas.length) fields.apiSchemas = schemas;
    kept._extractPrimData.call(this, plain, path, fields, specs, types);
    const sets = Object.keys(data)
      .filter((key) => SET.test(key))
      .map((key) => [key, SET.exec(key).at(1)]);
    if (sets.length) fields.variantSetChildren = sets.map(([, set]) => set);
    for (const [key, set] of sets)
      for (const [name, variant] of Object.entries(data[key]))
        this.variantSpec(variant, `${path}/{${set}=${name.replace(/"/g, "")}}`, specs, types);
    for (const [key, note] of Object.entries(withoutPrefixes(notes))) {
      const spec = specs[`${path}.${key.replace(/^uniform\s+/, "").split(/\s+/)[1]}`];
      if (!spec) continue;
      if (note.interpolation) spec.fields.interpolation = note.interpolation.replace(/"/g, "");
      if (note.elementSize) spec.fields.elementSize = Number(note.elementSize);
    }
  },
  // A variant, or a prim in one.
  variantSpec(data, path, specs, types, typeName = "") {
    if (!data || typeof data !== "object") return;
    const fields = { typeName };
    specs[path] = { specType: typeName || !path.endsWith("}") ? types.Prim : VARIANT, fields };
    this._extractPrimData(data, path, fields, specs, types);
    for (const key of Object.keys(data)) {
      const [, kind, name] = /^def\s+(?:(\w+)\s+)?"([^"]+)"$/.exec(key) ?? [];
      if (!name) continue;
      (fields.primChildren ??= []).push(name);
      this.variantSpec(data[key], `${path}/${name}`, specs, types, kind);
    }
  },
});

// The parser knows prims that begin with "def" alone.
function asDefinitions(data) {
  const made = {};
  for (const symbol of Object.getOwnPropertySymbols(data)) made[symbol] = data[symbol];
  for (const [key, value] of Object.entries(data)) {
    const [, word] = /^(def|over|class)\b/.exec(key) ?? [];
    const part =
      value && typeof value === "object" && (word || SET.test(key) || /^"/.test(key)) ? asDefinitions(value) : value;
    if (word && part === value) continue;
    if (word) part[SPECIFIER] = ["def", "over", "class"].indexOf(word);
    made[word ? key.replace(word, "def") : key] = part;
  }
  return made;
}

// "custom rel a" is "rel a", "prepend token b.connect" is "token b.connect".
function withoutPrefixes(data) {
  const given = Object.entries(data).filter(([, value]) => value !== "" && value !== "None");
  return Object.fromEntries(
    given.map(([key, value]) => [key.replace(/^(?:(?:custom|varying|prepend|append|add)\s+)+(?=\S+\s)/, ""), value]),
  );
}

// The parser wants one statement a line, as USD itself writes them.
function statements(line) {
  const body = /^((?:def|over|class)\b[^{]*)\{\s*(\S.*)$/.exec(line);
  if (body) {
    const inside = body[2].endsWith("}") ? [...body[2].slice(0, -1).split(";"), "}"] : [body[2]];
    return [
      ...statements(body[1].trim()),
      "{",
      ...inside
        .map((one) => one.trim())
        .filter(Boolean)
        .flatMap(statements),
    ];
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
  return [
    `${line.slice(0, at).trim()} (`,
    ...inside
      .split(";")
      .map((one) => one.trim())
      .filter(Boolean),
    ")",
  ];
}
