"""Registers of the ray tracer: their fields, and the writes that set a camera, a lighting and a material table."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.board.registers import REGISTERS

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from voxrt.board.view import Camera, Lighting

_PROBLEMS = {
    "direction_overflow": "a direction overflow",
    "bad_pointer": "a bad pointer",
    "step_limit": "an octree deeper than its depth",
}
_BUS_PROBLEMS = {
    "bus_error": "that the bus to its octree refused a read",
    "bus_timeout": "that the bus to its octree did not answer",
}
PROBLEMS = (*_PROBLEMS, *_BUS_PROBLEMS)
"""Fields of `status` that report a wrong frame."""

Writes = list[tuple[int, list[int]]]
"""Words by the address of the first of them."""


def encode_fields(name: str, **values: int) -> int:
    """Give the value of a register of these fields; others are 0.

    Examples
    --------
    >>> hex(encode_fields("size", width=640, height=480))
    '0x1e00280'
    """
    fields = REGISTERS[name][1]
    return sum((value & ((1 << fields[field][1]) - 1)) << fields[field][0] for field, value in values.items())


def decode_fields(name: str, value: int) -> dict[str, int]:
    """Give the fields of a register's value.

    Examples
    --------
    >>> decode_fields("size", 0x01E00280)
    {'width': 640, 'height': 480}
    """
    return {field: value >> low & ((1 << width) - 1) for field, (low, width) in REGISTERS[name][1].items()}


def tell_problems(status: Mapping[str, int]) -> str:
    """Say what `status` reports of a frame; empty if it was right.

    Examples
    --------
    >>> tell_problems(decode_fields("status", 1 << 12))
    'the ray tracer reports that the bus to its octree did not answer; open it again, and check the block design'
    """
    found = [problem for field, problem in _BUS_PROBLEMS.items() if status[field]]
    if found:
        return f"the ray tracer reports {' and '.join(found)}; open it again, and check the block design"
    found = [problem for field, problem in _PROBLEMS.items() if status[field]]
    if not found:
        return ""
    return f"the ray tracer reports {' and '.join(found)}; upload the scene again, or move the camera"


def register_writes(name: str, **fields: int) -> Writes:
    """Give the write of a register, by its fields."""
    return [(REGISTERS[name][0], [encode_fields(name, **fields)])]


def camera_writes(camera: Camera) -> Writes:
    """Give the writes that make the next frame show what a camera sees: four of three words each."""
    return [
        (
            REGISTERS[f"{name}[0]"][0],
            [encode_fields(f"{name}[{axis}]", value=value) for axis, value in enumerate(getattr(camera, name))],
        )
        for name in ("position", "look", "right", "up")
    ]


def lighting_writes(lighting: Lighting) -> Writes:
    """Give the writes that make the next frame use a lighting."""
    writes = register_writes(
        "shading",
        flat=lighting.flat,
        faces=lighting.faces is not None,
        light=lighting.on,
        ambient=lighting.ambient,
        bounces=lighting.bounces,
    )
    if lighting.faces is not None:
        for name, brightness in (("lower_faces", lighting.faces[::2]), ("upper_faces", lighting.faces[1::2])):
            writes += register_writes(name, **dict(zip("xyz", brightness, strict=True)))
    for axis, value in enumerate(lighting.position):
        writes += register_writes(f"light[{axis}]", value=value)
    return writes


def material_rows(colours: NDArray[np.uint8], mirrors: NDArray[np.bool_]) -> list[int]:
    """Give the 256 words of the material table."""
    return [
        bool(mirror) << 24 | red << 16 | green << 8 | blue
        for (red, green, blue), mirror in zip(colours.tolist(), mirrors.tolist(), strict=True)
    ]
