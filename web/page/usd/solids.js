// Cubes, spheres, cylinders, cones, capsules and planes of USD as triangles: those of voxelize/primitive_meshes.py.

const SEGMENTS = 128;
const AXES = { X: 0, Y: 1, Z: 2 };

// The dimensions of each solid and what they are where the file does not say, in the order of its function.
const SOLIDS = {
  Cube: [[["size", 2]], cube],
  Sphere: [[["radius", 1]], (radius) => revolved(arc(radius, -Math.PI / 2, Math.PI / 2, 0), "Z")],
  Cylinder: [
    [
      ["radius", 1],
      ["height", 2],
      ["axis", "Z"],
    ],
    (radius, height, axis) => cylinder(radius, radius, height, axis),
  ],
  Cylinder_1: [
    [
      ["radiusBottom", 1],
      ["radiusTop", 1],
      ["height", 2],
      ["axis", "Z"],
    ],
    cylinder,
  ],
  Cone: [
    [
      ["radius", 1],
      ["height", 2],
      ["axis", "Z"],
    ],
    (radius, height, axis) =>
      revolved(
        [
          [0, -height / 2],
          [radius, -height / 2],
          [0, height / 2],
        ],
        axis,
      ),
  ],
  Capsule: [
    [
      ["radius", 0.5],
      ["height", 1],
      ["axis", "Z"],
    ],
    (radius, height, axis) => capsule(radius, radius, height, axis),
  ],
  Capsule_1: [
    [
      ["radiusBottom", 0.5],
      ["radiusTop", 0.5],
      ["height", 1],
      ["axis", "Z"],
    ],
    capsule,
  ],
  Plane: [
    [
      ["width", 2],
      ["length", 2],
      ["axis", "Z"],
    ],
    plane,
  ],
};

export const isSolid = (kind) => Object.hasOwn(SOLIDS, kind);

// The solids that the loader does not know.
export const isNewSolid = (kind) => ["Cylinder_1", "Capsule_1", "Plane"].includes(kind);

// The values of a solid's dimensions. read(name): the file's, or null.
export function dimensionsOf(kind, path, read) {
  return SOLIDS[kind][0].map(([name, usual]) => {
    const value = read(name) ?? usual;
    if (name === "axis" && !(value in AXES))
      throw new Error(`${path}: axis '${value}' is not X, Y or Z; use one of them`);
    if (name !== "axis" && !(typeof value === "number" && value >= 0 && value < 1e70))
      throw new Error(`${path}: ${name} ${value} is not a length; use a positive number`);
    return value;
  });
}

// {positions, triangles}: three numbers per vertex, three vertices per triangle.
export const solidOf = (kind, dimensions) => SOLIDS[kind][1](...dimensions);

function cube(size) {
  const positions = [-1, 1]
    .flatMap((z) => [-1, 1].flatMap((y) => [-1, 1].flatMap((x) => [x, y, z])))
    .map((part) => part * (size / 2));
  const quads = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
  ];
  return { positions, triangles: quads.flatMap(([a, b, c, d]) => [a, b, c, a, c, d]) };
}

function plane(width, length, axis) {
  const [across, along] = { X: [2, 1], Y: [0, 2], Z: [0, 1] }[axis];
  const positions = new Array(12).fill(0);
  [
    [-1, -1],
    [1, -1],
    [1, 1],
    [-1, 1],
  ].forEach(([u, v], i) => {
    positions[3 * i + across] = (u * width) / 2;
    positions[3 * i + along] = (v * length) / 2;
  });
  return { positions, triangles: axis === "Z" ? [0, 1, 2, 0, 2, 3] : [2, 1, 0, 3, 2, 0] };
}

function cylinder(bottom, top, height, axis) {
  return revolved(
    [
      [0, -height / 2],
      [bottom, -height / 2],
      [top, height / 2],
      [0, height / 2],
    ],
    axis,
  );
}

function capsule(bottom, top, height, axis) {
  return revolved([...arc(bottom, -Math.PI / 2, 0, -height / 2), ...arc(top, 0, Math.PI / 2, height / 2)], axis);
}

// Part of a circle as radius and height; a half turn has half of the segments.
function arc(radius, start, stop, centre) {
  const steps = Math.round((SEGMENTS * (stop - start)) / (2 * Math.PI));
  return Array.from({ length: steps + 1 }, (_, i) => {
    const angle = i === steps ? stop : start + i * ((stop - start) / steps);
    return [
      Math.abs(Math.abs(angle) - Math.PI / 2) < 1e-12 ? 0 : radius * Math.cos(angle),
      centre + radius * Math.sin(angle),
    ];
  });
}

const rounded = (value) => Math.round(value * 1e15) / 1e15; // exact zeros and ones on the axes

// A closed surface of revolution of a profile, radius and height from bottom to top; the ends have radius 0.
function revolved(profile, axis) {
  const turn = (AXES[axis] + 1) % 3;
  const positions = [];
  const put = (x, y, z) => {
    const at = positions.length;
    positions.push(0, 0, 0);
    [x, y, z].forEach((part, i) => {
      positions[at + ((i + turn) % 3)] = part;
    });
  };
  put(0, 0, profile[0][1]);
  put(0, 0, profile.at(-1)[1]);
  const rings = profile.slice(1, -1);
  for (const [radius, height] of rings)
    for (let i = 0; i < SEGMENTS; i++) {
      const angle = (2 * Math.PI * i) / SEGMENTS;
      put(radius * rounded(Math.cos(angle)), radius * rounded(Math.sin(angle)), height);
    }
  const around = Array.from({ length: SEGMENTS }, (_, here) => [here, (here + 1) % SEGMENTS]);
  const triangles = around.flatMap(([here, there]) => [0, 2 + there, 2 + here]);
  for (let ring = 0; ring < rings.length - 1; ring++) {
    const [low, high] = [2 + ring * SEGMENTS, 2 + (ring + 1) * SEGMENTS];
    triangles.push(...around.flatMap(([here, there]) => [low + here, low + there, high + there]));
    triangles.push(...around.flatMap(([here, there]) => [low + here, high + there, high + here]));
  }
  const top = 2 + (rings.length - 1) * SEGMENTS;
  triangles.push(...around.flatMap(([here, there]) => [1, top + here, top + there]));
  return { positions, triangles };
}
