"""A ray's way through the octree, told to people: a row a word."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.sim import FACE_NONE

if TYPE_CHECKING:
    from voxrt.octree import Rom
    from voxrt.sim import RayPath, Reading

HEADS = ("step", "address", "word", "level", "x", "y", "z", "entered at", "T", "is")
"""What the columns of :func:`ray_table` hold; x, y, z are the octant's first and last voxels."""


def ray_table(rom: Rom, path: RayPath) -> list[tuple[str, ...]]:
    """Give a row of text for each word that a ray read."""
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


def describe_root(rom: Rom, path: RayPath) -> str:
    """Say what word 0 is, which every ray begins at and none reads."""
    return f"word 0 is 0x{path.root:08X}, {_meaning(rom, path.root)}; kept from ray to ray"


def describe_end(rom: Rom, path: RayPath) -> str:
    """Say what the ray hit."""
    if path.cell is None:
        return "nothing: the ray leaves the world"
    x, y, z = path.cell
    side = f"its {'xyz'[path.face]} side" if path.face != FACE_NONE else "from within"
    return f"voxel {x}, {y}, {z}, {side}: {_name(rom, path.material)}"


def _plane(path: RayPath, reading: Reading) -> str:
    """Name the plane that the ray crossed last."""
    if reading.axis == FACE_NONE:
        return "the eye"
    return f"{'xyz'[reading.axis]} = {path.point(reading.time)[reading.axis]:g}"


def _meaning(rom: Rom, word: int) -> str:
    if not word >> 31:
        return f"pointer to 0x{word:X}"
    return f"leaf: {_name(rom, word & 0xFF)}"


def _name(rom: Rom, material: int) -> str:
    return f"material {material}, {rom.materials[material].name}" if material else "empty"
