"""The cases of the acid test: small meshes of our own, each after a public issue about wrong voxels or wrong insides.

The issues are of voxelizers, of tools that need one, and of the inside tests that voxelizers use. The geometry is made
anew, small, from the description.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from acid.shapes import (
    SIDES,
    ball,
    box,
    cone,
    corners,
    cube,
    faces_of,
    height_field,
    plate,
    polygon,
    prism,
    regular,
    rotation,
    slab_with_notch,
    some_turned,
    split_edge_box,
    star,
    tube,
    turned,
    without,
)

if TYPE_CHECKING:
    from acid.checker import Point, Triangle


@dataclass(frozen=True)
class Case:
    """A mesh on a grid of 2**depth voxels per axis."""

    name: str
    issue: str
    """Repository and number of the issue, or pull request, after which it is made."""
    triangles: list[Triangle]
    depth: int = 4
    boundary: list[Triangle] | None = None
    """The closed surface that the triangles stand for, where they are turned, repeated or incomplete."""
    origin: Point = (0, 0, 0)
    """Where voxel (0, 0, 0) lies, in voxels."""

    @property
    def surface(self) -> list[Triangle]:
        """The triangles by which the voxels are judged."""
        return self.boundary or self.triangles


TETRAHEDRON = faces_of([(2, 2, 2), (14, 2, 2), (2, 14, 2), (2, 2, 14)], [(0, 2, 1), (0, 3, 2), (0, 1, 3), (1, 2, 3)])
THIN = 1 / 4096
HOLED_BOX = cube(3, 13)
WAVES = [8, 11, 9, 6, 10, 12, 7]


CASES = [
    # Boxes and the planes of the grid
    Case("cube of ten", "cpederkoff/stl-to-voxel#51", cube(3, 13)),
    Case("cube of eight, the whole grid", "Forceflow/cuda_voxelizer#64", cube(0, 8), depth=3),
    Case("sphere as large as the grid", "tunabrain/sparse-voxel-octrees#5", ball((8, 8, 8), 8, 8, 12)),
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
    Case("wall of a hollow cylinder", "sgsellan/swept-volumes#5", tube((8, 8), (6, 5.7), (3, 13))),
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
    Case("sheet thinner than the lattice shows", "firetools/blenderfds#15", box((3, 3, 8), (13, 13, 8 + THIN))),
    Case(
        "flat roof of no volume",
        "marian42/mesh_to_sdf#5",
        polygon((3, 3, 8.5), (13, 3, 8.5), (13, 13, 8.5), (3, 13, 8.5))
        + turned(polygon((3, 3, 8.5), (13, 3, 8.5), (13, 13, 8.5), (3, 13, 8.5))),
    ),
    Case("plate about the centres", "ProjectPhysX/FluidX3D#281", box((3, 3, 8.5 - THIN), (13, 13, 8.5 + THIN))),
    Case("wire along the centres", "ProjectPhysX/FluidX3D#281", box((3, *(8.5 - THIN,) * 2), (13, *(8.5 + THIN,) * 2))),
    Case(
        "bore along the centres",
        "AcademySoftwareFoundation/openvdb#1867",
        cube(3, 13) + turned(box((4, *(8.5 - THIN,) * 2), (12, *(8.5 + THIN,) * 2))),
    ),
    Case(
        "gap about the centres",
        "AcademySoftwareFoundation/openvdb#903",
        box((3, 3, 3), (8.5 - THIN, 13, 13)) + box((8.5 + THIN, 3, 3), (14, 13, 13)),
    ),
    Case(
        "ridge a little above the centres",
        "SCIInstitute/ShapeWorks#2033",
        prism([(2, 2.5), (14, 2.5), (14, 2.5 + THIN), (8.5, 8.5 + THIN), (2, 2.5 + THIN)], 3, 13),
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
        cube(2, 5) + ball((11, 11, 4), 2.5) + box((9, 2, 9), (14, 4, 14)),
    ),
    Case("corners under every centre", "mikedh/trimesh#242", height_field(lambda _i, _j: 9.5, 11, 1, 2.5)),
    Case(
        "ray through a corner",
        "pyvista/pyvista#8133",
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
    Case("two legs under a bridge", "mikedh/trimesh#200", slab_with_notch(), depth=5),
    Case("corkscrew of triangles", "mikedh/trimesh#79", tube((8, 8), (7, 3), (2, 12), 9)),
    Case(
        "a head with ears",
        "fwilliams/point-cloud-utils#109",
        ball((8, 8, 6), 4.6)
        + cone([(3.5, 7, 9), (5.5, 7, 9.5), (5.2, 9, 9.5)][::-1], (3, 8, 15))
        + cone([(10.5, 7, 9.5), (12.5, 7, 9), (12, 9, 9)][::-1], (13, 8, 15)),
    ),
    # Surfaces that cross or repeat themselves
    Case("boxes that cross", "mikedh/trimesh#1416", cube(2, 10) + cube(6, 14)),
    Case(
        "cylinders that cross",
        "pyvista/pyvista#6677",
        prism(regular(10, 4, (6, 8)), 3, 13) + prism(regular(10, 4, (10, 8)), 3, 13),
    ),
    Case(
        "star that crosses itself",
        "mikedh/trimesh#1416",
        star(regular(5, 7, (8, 8), 0.3)[::2] + regular(5, 7, (8, 8), 0.3)[1::2], 4, 12),
    ),
    Case("a box within a box", "pyvista/pyvista#6677", cube(2, 14) + cube(5, 11)),
    Case("faces twice, once per way", "libigl/libigl#644", cube(3, 13) + turned(cube(3, 13)), boundary=cube(3, 13)),
    Case("faces twice", "kctess5/voxelizer#1", cube(4, 12) + cube(4, 12), boundary=cube(4, 12)),
    Case(
        "boxes that share a wall",
        "isl-org/Open3D#5516",
        box((2, 3, 3), (8, 13, 13)) + box((8, 3, 3), (14, 13, 13)),
        boundary=box((2, 3, 3), (14, 13, 13)),
    ),
    Case(
        "triangles without an area",
        "MeshInspector/MeshLib#5733",
        cube(3, 13) + [(t[0], t[1], t[1]) for t in cube(3, 13)[:4]],
        boundary=cube(3, 13),
    ),
    Case(
        "T-junctions",
        "Xiangyu-Hu/SPHinXsys#888",
        split_edge_box((3, 3, 3), (13, 13, 12)),
        boundary=box((3, 3, 3), (13, 13, 12)),
    ),
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
    Case("hollow cylinder", "Forceflow/cuda_voxelizer#14", tube((8, 8), (6, 3), (2, 14))),
    Case("solid sphere", "topskychen/voxelizer#14", ball((8, 8, 8), 7)),
    # Faces turned
    Case("all faces inwards", "flexcompute/tidy3d#1976", turned(ball((8, 8, 8), 5)), boundary=ball((8, 8, 8), 5)),
    Case(
        "every third face turned",
        "GavinBarill/fast-winding-number-soups#2",
        some_turned(ball((8, 8, 8), 6), 3),
        boundary=ball((8, 8, 8), 6),
    ),
    Case("one face turned", "lcpp-org/RustBCA#238", turned(HOLED_BOX[:1]) + HOLED_BOX[1:], boundary=HOLED_BOX),
    Case("one piece inwards", "PyMesh/PyMesh#93", cube(2, 7) + turned(cube(9, 14)), boundary=cube(2, 7) + cube(9, 14)),
    # Holes and open surfaces
    Case("one triangle is missing", "cpederkoff/stl-to-voxel#47", without(HOLED_BOX, 11), boundary=HOLED_BOX),
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
        "acfr/snark#119",
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
