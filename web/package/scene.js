// Objects of three.js as a scene for Voxrt.voxelize. Nothing of three.js is imported: only what its objects hold is read.
//
//     const scene = sceneOf(mesh, voxrt);
//     const { words } = voxrt.voxelize(scene, { depth: 7 });
//
// Each visible mesh becomes an object, in the order of the scene graph; positions are those of the moment, with morph
// targets and skins applied. Textures that are in memory and vertex colours give triangles an appearance; a plain
// material counts by its colour. What else materials have is said in `warnings`.

const PAINTED = Symbol("painted"); // in place of the material of a triangle with an appearance
const DEFAULT = { name: "default", colour: [200, 200, 200], authored: false };

// How a file differs from a scene graph. groupOf(mesh): what makes meshes one object; nameOf(mesh, group);
// materialOf(material): {key, name, order, colour}, where colour is sRGB and absent for that of the material.
// appearanceOf(material, geometry, warn): null, or {entry, uvOf, colourOf}: an entry of a surface (voxrt.js), the same
// object for the same look; uvOf(vertex, out) and colourOf(vertex, out) set two and four numbers, or are null.
// isLeftOut(material): whether it is fully transparent. normalsOf(mesh): an attribute with the author's normals, or null.
const PLAIN = {
  normalsOf: (mesh) => (isDeformed(mesh) ? null : mesh.geometry.getAttribute("normal")),
  appearanceOf: appearanceOfThree,
  isLeftOut: () => false,
  groupOf: (mesh) => mesh,
  nameOf: (mesh) => mesh.name || "mesh",
  materialOf: (material) => (material ? { key: material, name: material.name || "material" } : null),
};

export function sceneOf(root, voxrt, rules = {}) {
  const { groupOf, nameOf, materialOf, appearanceOf, isLeftOut, normalsOf } = { ...PLAIN, ...rules };
  root.updateMatrixWorld?.(true);
  const warnings = new Map();
  const warn = (kind, message, count = 1) => {
    if (count) warnings.set(message, { kind, message, count: (warnings.get(message)?.count ?? 0) + count });
  };
  const groups = new Map();
  visit(root, (mesh) => {
    if (mesh.isPoints || mesh.isLine)
      warn("no-area", `${mesh.isPoints ? "points" : "lines"} were left out: they have no area to voxelize`);
    if (!mesh.isMesh || !mesh.geometry?.getAttribute("position")) return;
    const key = groupOf(mesh);
    groups.set(key, [...(groups.get(key) ?? []), mesh]);
  });
  const table = new Map(); // key -> {name, colour, order, ...}
  const use = (material) => {
    const found = materialOf(material) ?? { ...DEFAULT, key: DEFAULT, order: Infinity };
    if (!table.has(found.key))
      table.set(found.key, { order: table.size, ...found, colour: found.colour ?? colourOf(material, voxrt) });
    return found.key;
  };
  const meshes = [];
  const objects = [];
  const known = new Map(); // what parts that do not deform show -> mesh
  for (const [group, parts] of groups) {
    const look = parts.some(isDeformed)
      ? null
      : parts.map(({ geometry, material }) => [geometry.id, [material].flat().map((one) => one?.id)].join()).join(";");
    if (!known.has(look)) {
      const made = joined(parts, { use, warn, appearanceOf, isLeftOut, normalsOf });
      known.set(look, made.triangles.length ? meshes.push(made) - 1 : -1);
    }
    const mesh = known.get(look);
    known.delete(null);
    if (mesh < 0) continue;
    parts[0].updateMatrixWorld?.();
    const placed = parts[0].isInstancedMesh
      ? Array.from({ length: parts[0].count }, (_, i) =>
          product(parts[0].matrixWorld.elements, parts[0].instanceMatrix.array.subarray(16 * i, 16 * i + 16)),
        )
      : [parts[0].matrixWorld.elements];
    placed.forEach((matrix, i) =>
      objects.push({
        name: nameOf(parts[0], group) + (placed.length > 1 ? ` [${i}]` : ""),
        mesh,
        transform: rows(matrix),
      }),
    );
  }
  const ordered = [...table].sort(([, a], [, b]) => a.order - b.order);
  const ids = new Map(ordered.map(([key], i) => [key, i + 1]));
  for (const mesh of meshes) {
    mesh.materials = Uint8Array.from(mesh.keys, (key) => (key === PAINTED ? 0 : ids.get(key)));
    delete mesh.keys;
  }
  const bare = ids.get(DEFAULT);
  if (bare !== undefined)
    warn(
      "default-material",
      "faces without a material got the default one",
      meshes.reduce((sum, mesh) => sum + mesh.materials.filter((id) => id === bare).length, 0),
    );
  const materials = ordered.map(([, { name, colour, mirror = false, authored = true }]) => ({
    name,
    colour,
    mirror,
    authored,
  }));
  return { materials, meshes, objects, warnings: [...warnings.values()] };
}

function visit(object, see) {
  if (!object.visible) return;
  see(object);
  for (const child of object.children) visit(child, see);
}

// Several meshes of one place as one: positions, triangles, the material of each triangle, and their surface.
function joined(parts, { use, warn, appearanceOf, isLeftOut, normalsOf }) {
  const [positions, triangles, keys, painted, given] = [[], [], [], [], []];
  let first = 0;
  for (const mesh of parts) {
    const { geometry } = mesh;
    const place = positionsOf(mesh);
    const count = place.length / 3;
    const corners = geometry.index
      ? geometry.index.array.subarray(0, geometry.index.count)
      : Uint32Array.from({ length: count }, (_, i) => i);
    const whole = corners.length - (corners.length % 3);
    if (whole < corners.length)
      warn("incomplete-triangle", "corners after the last whole triangle of a primitive were left out");
    const several = Array.isArray(mesh.material) ? mesh.material : null;
    const runs =
      several && geometry.groups.length
        ? geometry.groups.map(({ start, count: length, materialIndex }) => [
            start,
            Math.min(start + length, whole),
            several[materialIndex],
          ])
        : [[0, whole, several ? several[0] : mesh.material]];
    for (const [start, end, material] of runs) {
      if (end <= start) continue;
      const look = appearanceOf(material, geometry, warn);
      if (!look && isLeftOut(material)) {
        warn("transparent", "fully transparent faces were left out", (end - start) / 3);
        continue;
      }
      let plain = null;
      const covers = (at) =>
        look &&
        (!look.covers || look.covers(corners[at]) || look.covers(corners[at + 1]) || look.covers(corners[at + 2]));
      for (let i = start; i < end; i += 3) {
        if (covers(i)) painted.push([triangles.length / 3, look, corners, i]);
        keys.push(covers(i) ? PAINTED : (plain ??= use(material)));
        triangles.push(corners[i] + first, corners[i + 1] + first, corners[i + 2] + first);
      }
    }
    positions.push(place);
    const normals = normalsOf(mesh);
    if (normals) given.push([first, normals]);
    first += count;
  }
  const all = new Float64Array(3 * first);
  positions.reduce((at, part) => (all.set(part, at), at + part.length), 0);
  const rows = Int32Array.from(triangles);
  return {
    positions: all,
    triangles: rows,
    keys,
    ...(painted.length && { surface: surfaceOf(painted, keys.length) }),
    ...(given.length && { normals: { directions: joinedNormals(given, first), rows } }),
  };
}

// `given`: [the first vertex, an attribute] each; zeros elsewhere.
function joinedNormals(given, count) {
  const single = given.every(([, { array }]) => array instanceof Float32Array);
  const all = new (single ? Float32Array : Float64Array)(3 * count);
  for (const [first, attribute] of given)
    for (let i = 0, at = 3 * first; i < attribute.count; i++, at += 3) {
      all[at] = attribute.getX(i);
      all[at + 1] = attribute.getY(i);
      all[at + 2] = attribute.getZ(i);
    }
  return all;
}

function surfaceOf(painted, count) {
  const entries = [...new Set(painted.map(([, look]) => look.entry))];
  const numbers = new Map(entries.map((entry, i) => [entry, i]));
  const rows = new Int32Array(count).fill(-1);
  const uv = new Float64Array(6 * count);
  const colours = new Float32Array(12 * count).fill(1);
  for (const [triangle, { entry, uvOf, colourOf }, corners, at] of painted) {
    rows[triangle] = numbers.get(entry);
    for (let corner = 0; corner < 3; corner++) {
      uvOf?.(corners[at + corner], uv.subarray(6 * triangle + 2 * corner));
      colourOf?.(corners[at + corner], colours.subarray(12 * triangle + 4 * corner));
    }
  }
  return { entries, rows, uv, colours };
}

const isDeformed = (mesh) =>
  mesh.isSkinnedMesh || (mesh.morphTargetInfluences?.some((weight) => weight !== 0) ?? false);

function positionsOf(mesh) {
  const attribute = mesh.geometry.getAttribute("position");
  const deformed = isDeformed(mesh);
  if (!deformed && !attribute.isInterleavedBufferAttribute && !attribute.normalized && attribute.itemSize === 3)
    return attribute.array.subarray(0, 3 * attribute.count);
  const positions = new Float64Array(3 * attribute.count);
  if (!deformed) {
    for (let i = 0; i < attribute.count; i++)
      positions.set([attribute.getX(i), attribute.getY(i), attribute.getZ(i)], 3 * i);
    return positions;
  }
  if (mesh.isSkinnedMesh) mesh.skeleton.update();
  const point = mesh.position.clone();
  for (let i = 0; i < attribute.count; i++) mesh.getVertexPosition(i, point).toArray(positions, 3 * i);
  return positions;
}

function colourOf(material, voxrt) {
  const { r, g, b } = material.color ?? { r: 1, g: 1, b: 1 };
  return [r, g, b].map((channel) => voxrt.srgb(channel));
}

const WRAPS = { 1000: "repeat", 1001: "clamp", 1002: "mirror" };
const NEAREST = 1003;

// The look of a material of three.js, apart from alpha.
const looks = new WeakMap();
function appearanceOfThree(material, geometry, warn) {
  const [colour, uv] = [material?.vertexColors && geometry.getAttribute("color"), geometry.getAttribute("uv")];
  const image = material?.map && uv ? pixelsOf(material.map, warn) : null;
  if (!colour && !image) return null;
  if (!looks.has(material)) looks.set(material, {});
  const { r, g, b } = material.color ?? { r: 1, g: 1, b: 1 };
  const known = looks.get(material);
  const kind = image ? "textured" : "coloured";
  known[kind] ??= {
    name: material.name || "material",
    factor: [r, g, b, 1],
    texture: image && {
      image,
      wrap: [WRAPS[material.map.wrapS], WRAPS[material.map.wrapT]],
      nearest: material.map.magFilter === NEAREST,
    },
  };
  return {
    entry: known[kind],
    uvOf: image && coordinatesOf(uv, material.map),
    colourOf: colour ? colours(colour) : null,
  };
}

// Sets u and v, which the texture's offset, repeat and rotation move.
function coordinatesOf(uv, texture) {
  texture.updateMatrix();
  const [a, b, , c, d, , e, f] = texture.matrix.elements;
  return (vertex, out) => {
    const [u, v] = [uv.getX(vertex), uv.getY(vertex)];
    out[0] = a * u + c * v + e;
    out[1] = b * u + d * v + f;
  };
}

// Sets linear colour and alpha from an attribute.
export const colours = (attribute) => (vertex, out) => {
  out[0] = attribute.getX(vertex);
  out[1] = attribute.getY(vertex);
  out[2] = attribute.getZ(vertex);
  out[3] = attribute.itemSize === 4 ? attribute.getW(vertex) : 1;
};

// The pixels of a texture, row 0 at v = 0; null where they cannot be read.
const read = new WeakMap();
function pixelsOf(texture, warn) {
  const { image } = texture;
  if (image && !read.has(image)) read.set(image, pixelsOfImage(image));
  const found = image ? read.get(image) : null;
  if (!found) warn("texture", "a texture cannot be read here; its material took its plain colour");
  return found && texture.flipY ? turned(found) : found;
}

function pixelsOfImage(image) {
  const { data, width, height } = image;
  if (data?.length === 4 * width * height && data.BYTES_PER_ELEMENT === 1) return { width, height, pixels: data };
  if (typeof OffscreenCanvas === "undefined" || !(image instanceof ImageBitmap)) return null;
  const context = new OffscreenCanvas(width, height).getContext("2d", { willReadFrequently: true });
  context.drawImage(image, 0, 0);
  return { width, height, pixels: context.getImageData(0, 0, width, height).data };
}

const upside = new WeakMap();
function turned(image) {
  if (!upside.has(image)) {
    const { width, height, pixels } = image;
    const made = new Uint8Array(pixels.length);
    for (let row = 0; row < height; row++)
      made.set(pixels.subarray(4 * width * row, 4 * width * (row + 1)), 4 * width * (height - 1 - row));
    upside.set(image, { width, height, pixels: made });
  }
  return upside.get(image);
}

// A matrix of three.js (columns) as 3 rows of 4.
const rows = (m) => [m[0], m[4], m[8], m[12], m[1], m[5], m[9], m[13], m[2], m[6], m[10], m[14]];

const product = (a, b) =>
  Array.from({ length: 16 }, (_, at) => {
    const [column, row] = [at >> 2, at & 3];
    return (
      a[row] * b[4 * column] +
      a[row + 4] * b[4 * column + 1] +
      a[row + 8] * b[4 * column + 2] +
      a[row + 12] * b[4 * column + 3]
    );
  });
