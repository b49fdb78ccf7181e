"""The cases of the acid test: small meshes of our own, each after a public issue about wrong voxels or wrong insides.

Points are triples of whole numbers, in units of 1/4096 voxel (``checker.UNIT``). The geometry of an issue is made
anew, small, from its description. ``CASES`` has them all.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from acid.checker import UNIT

Point = tuple[int, int, int]
Triangle = tuple[Point, Point, Point]
Real = Sequence[float]
SIDES = ((0, 4, 6, 2), (1, 3, 7, 5), (0, 1, 5, 4), (2, 6, 7, 3), (0, 2, 3, 1), (4, 5, 7, 6))
"""The corners of a box, x in bit 0, by side: -x, +x, -y, +y, -z, +z; counter-clockwise seen from outside."""


@dataclass(frozen=True)
class Case:
    """A mesh on a grid of 2**depth voxels per axis."""

    name: str
    issue: str
    """Repository and number of the issue, or pull request, after which it is made."""
    triangles: list[Triangle]
    depth: int = 4
    meant: list[Triangle] | None = None
    """The closed surface that the triangles stand for, where they are turned, repeated or incomplete."""
    origin: Point = (0, 0, 0)
    """Where voxel (0, 0, 0) lies, in voxels."""

    @property
    def surface(self) -> list[Triangle]:
        """The triangles by which the voxels are judged."""
        return self.meant or self.triangles


def at(*points: Real) -> list[Point]:
    """Points given in voxels, on the lattice."""
    return [tuple(round(v * UNIT) for v in p) for p in points]  # type: ignore[misc]


def polygon(*points: Real) -> list[Triangle]:
    """A convex polygon in space."""
    a, *others = at(*points)
    return [(a, b, c) for b, c in pairwise(others)]


def faces_of(points: Sequence[Real], faces: Sequence[Sequence[int]]) -> list[Triangle]:
    return [t for face in faces for t in polygon(*(points[i] for i in face))]


def turned(triangles: list[Triangle]) -> list[Triangle]:
    return [(a, c, b) for a, b, c in triangles]


def corners(low: Real, high: Real) -> list[Real]:
    ends = (low, high)
    return [(ends[i & 1][0], ends[i >> 1 & 1][1], ends[i >> 2][2]) for i in range(8)]


def box(low: Real, high: Real, turn: Callable[[Real], Real] = tuple) -> list[Triangle]:
    return faces_of([turn(p) for p in corners(low, high)], SIDES)


def cube(low: float, high: float) -> list[Triangle]:
    return box((low,) * 3, (high,) * 3)


def rotation(axis: Real, degrees: float, centre: Real = (8, 8, 8)) -> Callable[[Real], Real]:
    """Turn about an axis through a point (Rodrigues)."""
    length = math.hypot(*axis)
    u = [v / length for v in axis]
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))

    def turn(point: Real) -> Real:
        p = [a - b for a, b in zip(point, centre, strict=True)]
        along = sum(a * b for a, b in zip(u, p, strict=True)) * (1 - c)
        across = (u[1] * p[2] - u[2] * p[1], u[2] * p[0] - u[0] * p[2], u[0] * p[1] - u[1] * p[0])
        return tuple(o + c * a + s * b + along * w for o, a, b, w in zip(centre, p, across, u, strict=True))

    return turn


def ball(centre: Real, radius: float, rings: int = 6, around: int = 10) -> list[Triangle]:
    """A sphere of latitudes and longitudes."""

    def point(i: int, j: int) -> Real:
        up, side = math.pi * i / rings, 2 * math.pi * (j % around) / around
        unit = (math.sin(up) * math.cos(side), math.sin(up) * math.sin(side), math.cos(up))
        return tuple(c + radius * v for c, v in zip(centre, unit, strict=True))

    found: list[Triangle] = []
    for i in range(rings):
        for j in range(around):
            a, b, c, d = point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)
            found += ([] if i == rings - 1 else polygon(a, b, c)) + ([] if i == 0 else polygon(a, c, d))
            if i == rings - 1:
                found[-1:] = polygon(a, b, d)
    return found


def prism(outline: Sequence[Sequence[float]], low: float, high: float) -> list[Triangle]:
    """A column over a convex outline in x and y, counter-clockwise."""
    bottom, top = [(x, y, low) for x, y in outline], [(x, y, high) for x, y in outline]
    found = polygon(*reversed(bottom)) + polygon(*top)
    for i in range(len(outline)):
        found += polygon(bottom[i - 1], bottom[i], top[i], top[i - 1])
    return found


def tube(centre: Real, outer: float, inner: float, low: float, high: float, around: int = 12) -> list[Triangle]:
    """A hollow cylinder along z."""

    def ring(radius: float, z: float) -> list[Real]:
        angles = (2 * math.pi * i / around for i in range(around))
        return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a), z) for a in angles]

    rings = ring(outer, low), ring(outer, high), ring(inner, high), ring(inner, low)
    found: list[Triangle] = []
    for below, above in zip(rings, (*rings[1:], rings[0]), strict=True):
        for i in range(around):
            found += polygon(below[i - 1], below[i], above[i], above[i - 1])
    return found


def height_field(heights: Callable[[int, int], float], count: int, step: float, low: float = 2) -> list[Triangle]:
    """A solid under heights at the points of a square grid that starts at (2, 2)."""

    def top(i: int, j: int) -> Real:
        return (2 + step * i, 2 + step * j, heights(i, j))

    def bottom(i: int, j: int) -> Real:
        return (2 + step * i, 2 + step * j, low)

    found: list[Triangle] = []
    for i in range(count):
        for j in range(count):
            a, b, c, d = (i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)
            found += polygon(top(*a), top(*b), top(*c)) + polygon(top(*a), top(*c), top(*d))
            found += polygon(bottom(*c), bottom(*b), bottom(*a)) + polygon(bottom(*d), bottom(*c), bottom(*a))
    rim = [(i, 0) for i in range(count)] + [(count, j) for j in range(count)]
    rim += [(count - i, count) for i in range(count)] + [(0, count - j) for j in range(count)]
    for p, q in pairwise([*rim, rim[0]]):
        found += polygon(bottom(*p), bottom(*q), top(*q)) + polygon(bottom(*p), top(*q), top(*p))
    return found


def cone(base: Sequence[Real], apex: Real) -> list[Triangle]:
    """A pyramid over a convex base, counter-clockwise seen from outside."""
    found = polygon(*base)
    for i in range(len(base)):
        found += polygon(base[i], base[i - 1], apex)
    return found


def regular(count: int, radius: float, centre: Sequence[float], start: float = 0) -> list[Sequence[float]]:
    angles = (start + 2 * math.pi * i / count for i in range(count))
    return [(centre[0] + radius * math.cos(a), centre[1] + radius * math.sin(a)) for a in angles]


def without(triangles: list[Triangle], *left_out: int) -> list[Triangle]:
    return [t for i, t in enumerate(triangles) if i not in left_out]


def some_turned(triangles: list[Triangle], every: int) -> list[Triangle]:
    return [(a, c, b) if i % every == 1 else (a, b, c) for i, (a, b, c) in enumerate(triangles)]


def plate(degrees: float, axis: Real = (0, 1, 0), thickness: float = 0.02) -> list[Triangle]:
    low, high = 8.25 - thickness / 2, 8.25 + thickness / 2
    return box((3, 3, low), (13, 13, high), rotation(axis, degrees, (8, 8, 8.25)))


def moved(triangles: list[Triangle], by: Real) -> list[Triangle]:
    shift = at(by)[0]
    return [tuple(tuple(a + b for a, b in zip(p, shift, strict=True)) for p in t) for t in triangles]  # type: ignore[misc]


def split_edge_box(low: Real, high: Real) -> list[Triangle]:
    """A box whose top has a corner more on one edge than the side below it."""
    points = corners(low, high)
    a, b, c, d = (points[i] for i in SIDES[5])
    middle = tuple((u + v) / 2 for u, v in zip(a, b, strict=True))
    return box(low, high)[:10] + polygon(a, middle, d) + polygon(middle, b, c) + polygon(middle, c, d)


def star(outline: Sequence[Sequence[float]], low: float, high: float) -> list[Triangle]:
    """A column over an outline that crosses itself: its ends are fans about the middle."""
    x, y = (sum(p[i] for p in outline) / len(outline) for i in (0, 1))
    found: list[Triangle] = []
    for i in range(len(outline)):
        (ax, ay), (bx, by) = outline[i - 1], outline[i]
        found += polygon((x, y, high), (ax, ay, high), (bx, by, high))
        found += polygon((x, y, low), (bx, by, low), (ax, ay, low))
        found += polygon((ax, ay, low), (bx, by, low), (bx, by, high), (ax, ay, high))
    return found


TETRAHEDRON = faces_of([(2, 2, 2), (14, 2, 2), (2, 14, 2), (2, 2, 14)], [(0, 2, 1), (0, 3, 2), (0, 1, 3), (1, 2, 3)])
THIN = 1 / 4096
HOLED_BOX = cube(3, 13)
WAVES = [8, 11, 9, 6, 10, 12, 7]


def slab_with_notch() -> list[Triangle]:
    """Two legs under a bridge: a solid that is not convex."""
    outline = [(2, 2), (5, 2), (5, 9), (11, 9), (11, 2), (14, 2), (14, 13), (2, 13)]
    front = [(0, 1, 2), (0, 2, 7), (2, 3, 6), (2, 6, 7), (3, 4, 5), (3, 5, 6)]
    low, high = [(x, 3.5, z) for x, z in outline], [(x, 12.5, z) for x, z in outline]
    found = [t for f in front for t in polygon(*(low[i] for i in f)) + polygon(*(high[i] for i in reversed(f)))]
    for i in range(8):
        found += polygon(low[i], low[i - 1], high[i - 1], high[i])
    return found


CASES = [
    # Boxes and the planes of the grid
    Case("cube of ten", "cpederkoff/stl-to-voxel#51", cube(3, 13)),
    Case("cube of eight, the whole grid", "Forceflow/cuda_voxelizer#64", cube(0, 8), depth=3),
    Case("sphere of fifty to sixty-four", "tunabrain/sparse-voxel-octrees#5", ball((8, 8, 8), 8, 8, 12)),
    Case("face on the last plane", "imagej/imagej-ops#603", box((4, 4, 9), (12, 12, 16))),
    Case("cube between the planes", "karimnaaji/voxelizer#9", box((0.5, 0.49, 0.51), (6.5, 6.51, 6.49))),
    Case("faces on some planes", "Forceflow/cuda_voxelizer#7", box((2, 3.5, 4), (11, 9.25, 12))),
    Case("diagonal of a cube's face", "Forceflow/cuda_voxelizer#61", cube(2.001, 12.001)),
    Case("cube of two", "sylefeb/VoxSurf#10", cube(7, 9)),
    Case(
        "tapered cube",
        "sylefeb/VoxSurf#10",
        faces_of([*corners((3, 3, 4), (13, 13, 12))[:4], *corners((4, 4, 4), (12, 12, 12))[4:]], SIDES),
    ),
    Case("cube of four", "isl-org/Open3D#5704", box((6, 6, 0), (10, 10, 4))),
    Case("large faces", "isl-org/Open3D#6111", cube(1.5, 14.5)),
    Case(
        "cube at odd places",
        "isl-org/Open3D#6324",
        box((2.69434738, 3.5824585, 4.96587944), (12.66, 13.55, 14.59)),
        origin=(43, 265, 18),
    ),
    Case("box as large as its bounds", "isl-org/Open3D#6055", box((0, 0, 0), (16, 10, 6))),
    Case("cube at -6.7 and 1.2", "mattatz/unity-voxel#13", box((3.3, 3, 4.2), (13.3, 13, 14.2)), origin=(-70, -8, 10)),
    Case(
        "cube beside a diagonal", "marmakoide/inside-3d-mesh#1", box((4, 4, 4), (12, 12, 12), rotation((0, 0, 1), 45))
    ),
    Case("cube in negative space", "clbarnes/ncollpyde#8", turned(cube(4, 12)), origin=(-20, -20, -20)),
    Case("bounds that are no multiple", "pyvista/pyvista#6513", box((2.4, 2.4, 2.4), (13.7, 11.9, 9.1))),
    Case("stacked cubes", "pyvista/pyvista#7035", box((2, 2, 2), (14, 14, 6)) + box((5, 5, 6), (11, 11, 12))),
    Case("half a voxel beside", "NVIDIAGameWorks/kaolin#241", cube(3.5, 12.5)),
    Case("rays at whole numbers", "mikedh/trimesh#153", prism(regular(8, 6, (8, 8)), 2, 14)),
    # Thin things
    Case("upright plate", "ProjectPhysX/FluidX3D#160", box((3, 8.3, 2), (13, 8.32, 14))),
    *(Case(f"plate at {degrees}°", "ProjectPhysX/FluidX3D#281", plate(degrees)) for degrees in (0, 17, 30, 45, 60, 90)),
    Case("plate across two angles", "ProjectPhysX/FluidX3D#281", plate(33, (1, 2, 3))),
    Case("wall of a hollow cylinder", "sgsellan/swept-volumes#5", tube((8, 8), 6, 5.7, 3, 13)),
    Case(
        "backrest without thickness",
        "marian42/mesh_to_sdf#5",
        box((3, 3, 3), (13, 13, 5))
        + polygon((3, 12.5, 5.5), (13, 12.5, 5.5), (13, 12.5, 14))
        + polygon((13, 12.5, 5.5), (3, 12.5, 5.5), (13, 12.5, 14)),
    ),
    Case("smaller than a voxel", "Unity-Technologies/Graphics#6473", box((5.6, 6.6, 7.6), (5.9, 6.8, 7.7))),
    Case(
        "needles",
        "LucasDower/ObjToSchematic#30",
        cone([(3.1, 3.2, 2), (3.2, 3.1, 2), (3.3, 3.3, 2)][::-1], (13, 12, 14)),
    ),
    Case(
        "wedge with a sharp edge",
        "SCIInstitute/ShapeWorks#2033",
        faces_of(
            [(2, 3, 4), (2, 3, 8), (14, 3, 4), (2, 13, 4), (2, 13, 8), (14, 13, 4)],
            [(0, 2, 1), (3, 4, 5), (0, 3, 5, 2), (0, 1, 4, 3), (1, 2, 5, 4)],
        ),
    ),
    Case(
        "slivers",
        "nobuyuki83/delfem2#48",
        faces_of(
            [(2, 2, 2), (14, 13, 3), (14, 13.01, 3), (2, 2.01, 2.5)], [(0, 2, 1), (0, 3, 2), (0, 1, 3), (1, 2, 3)]
        ),
    ),
    Case("sheet thinner than the lattice shows", "prusa3d/PrusaSlicer#6713", box((3, 3, 8), (13, 13, 8 + THIN))),
    Case(
        "flat roof of no volume",
        "jsxcad/JSxCAD#568",
        polygon((3, 3, 8.5), (13, 3, 8.5), (13, 13, 8.5), (3, 13, 8.5))
        + turned(polygon((3, 3, 8.5), (13, 3, 8.5), (13, 13, 8.5), (3, 13, 8.5))),
    ),
    # Rays that meet vertices and edges
    Case(
        "height field on the lattice",
        "ProjectPhysX/FluidX3D#323",
        height_field(lambda i, j: WAVES[(2 * i + 3 * j) % 7], 12, 1),
    ),
    Case(
        "height field at the centres",
        "ProjectPhysX/FluidX3D#323",
        height_field(lambda i, j: WAVES[(i * i + j) % 7] + 0.5, 6, 1.5),
    ),
    Case("steep towers", "ProjectPhysX/FluidX3D#59", height_field(lambda i, j: 13 if (i + j) % 3 == 0 else 4, 6, 2)),
    Case(
        "parts that are not connected",
        "ProjectPhysX/FluidX3D#184",
        cube(2, 5) + ball((11, 11, 4), 2.5) + box((9, 2, 9), (14, 4, 14)) + TETRAHEDRON[:0],
    ),
    Case("corners under every centre", "mikedh/trimesh#242", height_field(lambda i, j: 9.5, 11, 1, 2.5)),
    Case(
        "ray through a corner",
        "Oblikovati/Oblikovati#1325",
        cone([(3, 8, 4), (8, 3, 4), (13, 8, 4), (8, 13, 4)][::-1], (8, 8, 13)),
    ),
    Case(
        "octahedron on the centres",
        "mikedh/trimesh#545",
        cone([(2.5, 8.5, 8.5), (8.5, 2.5, 8.5), (14.5, 8.5, 8.5), (8.5, 14.5, 8.5)][::-1], (8.5, 8.5, 14.5))[2:]
        + turned(
            cone([(2.5, 8.5, 8.5), (8.5, 2.5, 8.5), (14.5, 8.5, 8.5), (8.5, 14.5, 8.5)][::-1], (8.5, 8.5, 2.5))[2:]
        ),
    ),
    Case("tetrahedron", "NVIDIA/warp#1836", TETRAHEDRON),
    Case(
        "streaks beside a cube", "taichi-dev/taichi_elements#26", box((4, 4, 4), (12, 12, 12), rotation((0, 0, 1), 15))
    ),
    Case(
        "slices of one line",
        "guillaumechereau/goxel#322",
        box((2, 4.5, 2), (14, 5.5, 14)) + box((4, 9, 2), (5, 12, 14)),
    ),
    Case(
        "bars of a cage",
        "pyvista/pyvista#7549",
        box((2, 2, 2), (4, 4, 14))
        + box((12, 2, 2), (14, 4, 14))
        + box((2, 12, 2), (4, 14, 14))
        + box((12, 12, 2), (14, 14, 14)),
    ),
    Case("points of a sphere", "pyvista/pyvista#1743", ball((8, 8, 8), 5.5, 6, 8)),
    Case("signs about a sphere", "isl-org/Open3D#5669", ball((8, 8, 8), 6.4, 8, 12)),
    Case("a point on no plane", "pyvista/pyvista#4240", box((3, 3, 3), (13, 13, 13), rotation((1, 1, 1), 37))),
    Case("between two wings", "mikedh/trimesh#1896", slab_with_notch()),
    Case("two legs under a bridge", "mikedh/trimesh#200", [t for t in slab_with_notch()], depth=5),
    Case("corkscrew of triangles", "mikedh/trimesh#79", tube((8, 8), 7, 3, 2, 12, 9)),
    # Surfaces that cross or repeat themselves
    Case("boxes that cross", "mikedh/trimesh#1416", cube(2, 10) + cube(6, 14)),
    Case(
        "cylinders that cross",
        "pyvista/pyvista#6677",
        prism(regular(10, 4, (6, 8)), 3, 13) + prism(regular(10, 4, (10, 8)), 3, 13),
    ),
    Case(
        "star that crosses itself",
        "speps/LibTessDotNet#47",
        star(regular(5, 7, (8, 8), 0.3)[::2] + regular(5, 7, (8, 8), 0.3)[1::2], 4, 12),
    ),
    Case("a box within a box", "Oblikovati/Oblikovati#1327", cube(2, 14) + cube(5, 11)),
    Case("faces twice, once per way", "libigl/libigl#644", cube(3, 13) + turned(cube(3, 13)), meant=cube(3, 13)),
    Case("faces twice", "kctess5/voxelizer#1", cube(4, 12) + cube(4, 12), meant=cube(4, 12)),
    Case(
        "boxes that share a wall",
        "isl-org/Open3D#5516",
        box((2, 3, 3), (8, 13, 13)) + box((8, 3, 3), (14, 13, 13)),
        meant=box((2, 3, 3), (14, 13, 13)),
    ),
    Case(
        "triangles without an area",
        "libgdx/libgdx#4901",
        cube(3, 13) + [(t[0], t[1], t[1]) for t in cube(3, 13)[:4]],
        meant=cube(3, 13),
    ),
    Case("T-junctions", "ecto/vcad#790", split_edge_box((3, 3, 3), (13, 13, 12)), meant=box((3, 3, 3), (13, 13, 12))),
    # Shells in shells
    Case("nested shells", "AcademySoftwareFoundation/openvdb#111", ball((8, 8, 8), 6.5) + turned(ball((8, 8, 8), 4))),
    Case("hollow cube", "AcademySoftwareFoundation/openvdb#1867", cube(2, 14) + turned(cube(5, 11))),
    Case("ball in a cavity", "SCIInstitute/ShapeWorks#2033", cube(1, 15) + turned(cube(3, 13)) + ball((8, 8, 8), 3)),
    Case(
        "spheres that nearly touch",
        "AcademySoftwareFoundation/openvdb#903",
        ball((4.49, 8, 8), 3.49, 6, 8) + ball((11.51, 8, 8), 3.49, 6, 8),
    ),
    Case(
        "walls a sliver apart",
        "ProjectPhysX/FluidX3D#104",
        box((2, 3, 3), (8 - THIN, 13, 13)) + box((8, 3, 3), (14, 13, 13)),
    ),
    Case("hollow cylinder", "Forceflow/cuda_voxelizer#14", tube((8, 8), 6, 3, 2, 14)),
    Case("solid sphere", "topskychen/voxelizer#14", ball((8, 8, 8), 7)),
    # Faces turned
    Case("all faces inwards", "flexcompute/tidy3d#1976", turned(ball((8, 8, 8), 5)), meant=ball((8, 8, 8), 5)),
    Case(
        "every third face turned",
        "GavinBarill/fast-winding-number-soups#2",
        some_turned(ball((8, 8, 8), 6), 3),
        meant=ball((8, 8, 8), 6),
    ),
    Case("one face turned", "lcpp-org/RustBCA#238", turned(HOLED_BOX[:1]) + HOLED_BOX[1:], meant=HOLED_BOX),
    Case("one piece inwards", "PyMesh/PyMesh#93", cube(2, 7) + turned(cube(9, 14)), meant=cube(2, 7) + cube(9, 14)),
    # Holes and open surfaces
    Case("one triangle is missing", "cpederkoff/stl-to-voxel#47", without(HOLED_BOX, 11), meant=HOLED_BOX),
    Case("open sheet", "christopherbatty/SDFGen#4", polygon((2, 3, 4.5), (13, 2, 6.5), (14, 12, 9.5), (3, 13, 7.5))),
    Case("three faces of a tetrahedron", "AcademySoftwareFoundation/openvdb#1205", TETRAHEDRON[:3]),
    Case(
        "square of two triangles",
        "mikedh/trimesh#1487",
        polygon((0, 0, 8.5), (16, 0, 8.5), (16, 16, 8.5), (0, 16, 8.5)),
    ),
    Case(
        "sheet between voxels",
        "bzgeb/UnityGPUMeshVoxelizerPart5#1",
        polygon((2, 2, 8), (14, 2, 8), (14, 14, 8), (2, 14, 8)),
    ),
    # Far away, small, turned
    Case(
        "far from the origin",
        "CloudCompare/CloudCompare#232",
        box((3, 3, 3), (13, 12.5, 11.25), rotation((1, 2, 3), 23)),
        origin=(400000, 800000, 0),
    ),
    Case("small against its distance", "mikedh/trimesh#181", ball((8, 8, 8), 5), origin=(1 << 21, 1 << 21, 1 << 21)),
    Case(
        "cube turned by an irrational angle",
        "cpederkoff/stl-to-voxel#62",
        box((4, 4, 4), (12, 12, 12), rotation((math.sqrt(2), math.sqrt(3), math.sqrt(5)), 57.29577951)),
    ),
    Case(
        "box turned on its corner",
        "ad-si/Brickify#494",
        box((4, 4, 4), (12, 12, 12), rotation((1, -1, 0), math.degrees(math.atan(math.sqrt(2))))),
    ),
]
