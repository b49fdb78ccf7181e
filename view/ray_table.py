"""A ray's path through the octree as a table: one row per word."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.octree.words import is_leaf, material
from voxrt.sim import FACE_NONE

if TYPE_CHECKING:
    from voxrt.octree import Rom
    from voxrt.sim import RayPath, Reading

HEADS = ("step", "address", "word", "level", "x", "y", "z", "entered at", "T", "is")
"""The heads of the columns of :func:`ray_table`; x, y, z are the first and last voxels of the octant."""


def ray_table(rom: Rom | None, path: RayPath) -> list[tuple[str, ...]]:
    """Return a row of text for each word that a ray read; without a memory, materials have no names.

    Examples
    --------
    >>> from voxrt.octree import from_points
    >>> from voxrt.sim import follow_ray
    >>> path = follow_ray(from_points([[5, 2, 2]], [7], depth=3), (80, 40, 40), (0, 0, 1))
    >>> ray_table(None, path)[-1]
    ('3', '0x12', '0xFFFFFF07', '0', '5', '2', '2', 'the eye', '0', 'leaf: material 7')
    """
    return [
        (
            str(step),
            f"0x{reading.address:X}",
            f"0x{reading.word:08X}",
            str(reading.level),
            *(
                f"{first}-{end - 1}" if end - first > 1 else str(first)
                for first, end in zip(reading.corner, reading.end, strict=True)
            ),
            _plane(path, reading),
            str(reading.time),
            _meaning(rom, reading.word),
        )
        for step, reading in enumerate(path.readings, 1)
    ]


def describe_root(rom: Rom | None, path: RayPath) -> str:
    """Describe word 0. Every ray starts from it; it is kept between rays and not read again."""
    return f"word 0 is 0x{path.root:08X}, {_meaning(rom, path.root)}; kept from ray to ray"


def describe_end(rom: Rom | None, path: RayPath) -> str:
    """Describe what the ray hit."""
    if path.cell is None:
        return "nothing: the ray leaves the world"
    x, y, z = path.cell
    side = f"its {'xyz'[path.face]} side" if path.face != FACE_NONE else "from within"
    return f"voxel {x}, {y}, {z}, {side}: {_name(rom, path.material)}"


def _plane(path: RayPath, reading: Reading) -> str:
    """Return the plane that the ray crossed last."""
    if reading.axis == FACE_NONE:
        return "the eye"
    return f"{'xyz'[reading.axis]} = {path.point(reading.time)[reading.axis]:g}"


def _meaning(rom: Rom | None, word: int) -> str:
    if not is_leaf(word):
        return f"pointer to 0x{word:X}"
    return f"leaf: {_name(rom, material(word))}"


def _name(rom: Rom | None, material: int) -> str:
    if not material:
        return "empty"
    return f"material {material}" + ("" if rom is None else f", {rom.materials[material].name}")
