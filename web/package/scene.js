// Objects of three.js as a scene for Voxrt.voxelize. Nothing of three.js is imported: only what its objects hold is read.
//
//     const scene = sceneOf(mesh, voxrt);
//     const { words } = voxrt.voxelize(scene, { depth: 7 });
//
// Each visible mesh becomes an object, in the order of the scene graph; positions are those of the moment, with morph
// targets and skins applied. Materials count by their colour; what else they have is said in `warnings`.

const DEFAULT = { name: "default", colour: [200, 200, 200], authored: false };

// How a file differs from a scene graph. groupOf(mesh): what makes meshes one object; nameOf(mesh, group);
// materialOf(material): {key, name, order, colour}, where colour is sRGB and absent for that of the material.
const PLAIN = {
  groupOf: (mesh) => mesh,
  nameOf: (mesh) => mesh.name || "mesh",
  materialOf: (material) => (material ? { key: material, name: material.name || "material" } : null),
};

export function sceneOf(root, voxrt, rules = {}) {
  const { groupOf, nameOf, materialOf } = { ...PLAIN, ...rules };
  root.updateMatrixWorld?.(true);
  const warnings = new Map();
  const warn = (kind, message, count = 1) => {
    if (count) warnings.set(message, { kind, message, count: (warnings.get(message)?.count ?? 0) + count });
  };
  const groups = new Map();
  visit(root, (mesh) => {
    if (mesh.isPoints || mesh.isLine) warn("no-area", `${mesh.isPoints ? "points" : "lines"} were left out: they have no area to voxelize`);
    if (!mesh.isMesh || !mesh.geometry?.getAttribute("position")) return;
    const key = groupOf(mesh);
    groups.set(key, [...(groups.get(key) ?? []), mesh]);
  });
  const table = new Map(); // key -> {name, colour, order, ...}
  const use = (material) => {
    const found = materialOf(material) ?? { ...DEFAULT, key: DEFAULT, order: Infinity };
    if (!table.has(found.key)) table.set(found.key, { order: table.size, ...found, colour: found.colour ?? colourOf(material, voxrt, warn) });
    return found.key;
  };
  const meshes = [];
  const objects = [];
  for (const [group, parts] of groups) {
    const mesh = joined(parts, use, warn);
    if (!mesh.triangles.length) continue;
    meshes.push(mesh);
    parts[0].updateMatrixWorld?.();
    const placed = parts[0].isInstancedMesh
      ? Array.from({ length: parts[0].count }, (_, i) => product(parts[0].matrixWorld.elements, parts[0].instanceMatrix.array.subarray(16 * i, 16 * i + 16)))
      : [parts[0].matrixWorld.elements];
    placed.forEach((matrix, i) => objects.push({
      name: nameOf(parts[0], group) + (placed.length > 1 ? ` [${i}]` : ""), mesh: meshes.length - 1, transform: rows(matrix),
    }));
  }
  const ordered = [...table].sort(([, a], [, b]) => a.order - b.order);
  const ids = new Map(ordered.map(([key], i) => [key, i + 1]));
  for (const mesh of meshes) {
    mesh.materials = Uint8Array.from(mesh.keys, (key) => ids.get(key));
    delete mesh.keys;
  }
  const bare = ids.get(DEFAULT);
  if (bare) warn("default-material", "faces without a material got the default one", meshes.reduce((sum, mesh) => sum + mesh.materials.filter((id) => id === bare).length, 0));
  const materials = ordered.map(([, { name, colour, mirror = false, authored = true }]) => ({ name, colour, mirror, authored }));
  return { materials, meshes, objects, warnings: [...warnings.values()] };
}

function visit(object, see) {
  if (!object.visible) return;
  see(object);
  for (const child of object.children) visit(child, see);
}

// Several meshes of one place as one: positions, triangles, and the material of each triangle.
function joined(parts, use, warn) {
  const [positions, triangles, keys] = [[], [], []];
  let first = 0;
  for (const mesh of parts) {
    const { geometry } = mesh;
    const place = positionsOf(mesh);
    const count = place.length / 3;
    const corners = geometry.index ? geometry.index.array.subarray(0, geometry.index.count) : Uint32Array.from({ length: count }, (_, i) => i);
    const whole = corners.length - (corners.length % 3);
    if (whole < corners.length) warn("incomplete-triangle", "corners after the last whole triangle of a primitive were left out");
    const several = Array.isArray(mesh.material) ? mesh.material : null;
    const runs = several && geometry.groups.length
      ? geometry.groups.map(({ start, count: length, materialIndex }) => [start, Math.min(start + length, whole), several[materialIndex]])
      : [[0, whole, several ? several[0] : mesh.material]];
    for (const [start, end, material] of runs) {
      if (end <= start) continue;
      const key = use(material);
      for (let i = start; i < end; i++) triangles.push(corners[i] + first);
      for (let i = start; i < end; i += 3) keys.push(key);
    }
    positions.push(place);
    first += count;
  }
  const all = new Float64Array(3 * first);
  positions.reduce((at, part) => (all.set(part, at), at + part.length), 0);
  return { positions: all, triangles: Int32Array.from(triangles), keys };
}

function positionsOf(mesh) {
  const attribute = mesh.geometry.getAttribute("position");
  const deformed = mesh.isSkinnedMesh || (mesh.morphTargetInfluences?.some((weight) => weight !== 0) ?? false);
  if (!deformed && !attribute.isInterleavedBufferAttribute && !attribute.normalized && attribute.itemSize === 3)
    return attribute.array.subarray(0, 3 * attribute.count);
  const positions = new Float64Array(3 * attribute.count);
  if (!deformed) {
    for (let i = 0; i < attribute.count; i++) positions.set([attribute.getX(i), attribute.getY(i), attribute.getZ(i)], 3 * i);
    return positions;
  }
  if (mesh.isSkinnedMesh) mesh.skeleton.update();
  const point = mesh.position.clone();
  for (let i = 0; i < attribute.count; i++) mesh.getVertexPosition(i, point).toArray(positions, 3 * i);
  return positions;
}

function colourOf(material, voxrt, warn) {
  if (material.vertexColors) warn("vertex-colours", "vertex colours are not shown here; voxrt build shows them");
  const { r, g, b } = material.color ?? { r: 1, g: 1, b: 1 };
  const mean = material.map ? meanOf(material.map, warn) : [1, 1, 1];
  return [r, g, b].map((channel, i) => voxrt.srgb(channel * mean[i]));
}

// The mean colour of a texture, linear light.
function meanOf(texture, warn) {
  warn("texture", "textures are shown in their mean colour here; voxrt build shows them");
  const { image } = texture;
  if (!image || typeof OffscreenCanvas === "undefined") return [1, 1, 1];
  const canvas = new OffscreenCanvas(64, 64);
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(image, 0, 0, 64, 64);
  const { data } = context.getImageData(0, 0, 64, 64);
  const sums = [0, 0, 0];
  for (let i = 0; i < data.length; i += 4) for (let channel = 0; channel < 3; channel++) {
    const part = data[i + channel] / 255;
    sums[channel] += part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
  }
  return sums.map((sum) => (4 * sum) / data.length);
}

// A matrix of three.js (columns) as 3 rows of 4.
const rows = (m) => [m[0], m[4], m[8], m[12], m[1], m[5], m[9], m[13], m[2], m[6], m[10], m[14]];

const product = (a, b) => Array.from({ length: 16 }, (_, at) => {
  const [column, row] = [at >> 2, at & 3];
  return a[row] * b[4 * column] + a[row + 4] * b[4 * column + 1] + a[row + 8] * b[4 * column + 2] + a[row + 12] * b[4 * column + 3];
});
