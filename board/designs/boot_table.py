"""What the block RAMs of a board hold: the table of lists and cameras, and the encoded octree.

``docs/board-bus.md`` is the reference of both.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.board.register_writes import camera_writes, lighting_writes, material_rows, register_writes
from voxrt.board.registers import MATERIALS
from voxrt.octree._native import encoded_rows

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from numpy.typing import NDArray

    from voxrt.board.register_writes import Writes
    from voxrt.board.scene import Scene
    from voxrt.board.view import Camera, Lighting

TABLE_WORDS = 4096
CAMERAS_WORD = 2048
"""Where the orbit begins."""
CAMERAS = 128
CAMERA_WORDS = 16
TABLE = 0x004000
"""Address of the table."""
BOARD_REGISTERS = {
    name: 0x1000 + 4 * number
    for number, name in enumerate(
        (
            "identity",
            "version",
            "control",
            "camera",
            "play",
            "frames",
            "underruns",
            "late",
            "requests",
            "bad_requests",
            "refused",
            "clock",
        )
    )
} | {"frame_crc": 0x1038}
"""Addresses of the board's registers, by name. Designs of version 1.0 have no `frame_crc`."""
SDRAM_REGISTERS = {"page": 0x1030, "blocks": 0x1034}
"""Addresses of the registers that boards with SDRAM have besides, by name."""
RUN, TURN, REVERSE, STEERED = 1, 2, 4, 8
"""Bits of the board's `control`."""
OCTREE_MEMORY = 0x800000
"""Address of word 0 of the octree."""
PAGE_WORDS = 1 << 21
"""Words of the octree from there to the end of the map: a page."""
SCREEN = (640, 480)

_BURST = 255


def encode_list(writes: Iterable[tuple[int, Sequence[int]]], *, end: bool = True) -> list[int]:
    """Give the words of a list.

    Parameters
    ----------
    writes
        Address of the first word, and the words, in the order in which they are written.
    end
        Append END.

    Examples
    --------
    >>> [f"{word:08x}" for word in encode_list([(0x30, [1, 2])])]
    ['02000030', '00000001', '00000002', '00000000']
    """
    words: list[int] = []
    for address, data in writes:
        for start in range(0, len(data), _BURST):
            burst = data[start : start + _BURST]
            words += [len(burst) << 24 | (address + 4 * start), *burst]
    return [*words, 0] if end else words


def scene_writes(scene: Scene, lighting: Lighting, size: tuple[int, int], root: int = 0) -> Writes:
    """Give the writes that make the next frame show a scene, all but its octree and its camera.

    Parameters
    ----------
    scene
        Its colours and mirrors become the material table.
    lighting
        Light, mirrors, flat colours.
    size
        Columns and rows of the picture.
    root
        The word of the octree memory where the scene's word 0 is.
    """
    writes = register_writes("size", width=size[0], height=size[1])
    writes += (
        register_writes("depth", depth=scene.depth) + register_writes("root", address=root) + lighting_writes(lighting)
    )
    return [*writes, (MATERIALS, material_rows(scene.colours, scene.mirrors))]


def boot_table(
    scene: Scene,
    cameras: Sequence[Camera],
    lighting: Lighting,
    *,
    scale: int = 0,
    control: int = RUN | TURN,
    period: int = 3,
) -> NDArray[np.uint32]:
    """Give the table that a board starts from: the scene, its orbit, and no host.

    Parameters
    ----------
    scene
        Its octree is in the octree memory already, but for word 0. An animation plays along the orbit.
    cameras
        128 of them.
    lighting
        Light, mirrors, flat colours.
    scale
        0 ... 2: pictures of 640 x 480, 320 x 240 or 160 x 120 pixels.
    control
        Bits of the board's `control`: RUN, TURN, REVERSE, STEERED.
    period
        Frames per camera.

    Returns
    -------
    ndarray
        uint32, shape (4096,).

    Raises
    ------
    ValueError
        There are not 128 cameras.
    """
    if len(cameras) != CAMERAS:
        raise ValueError(f"an orbit has {CAMERAS} cameras, not {len(cameras)}")
    writes = scene_writes(scene, lighting, (SCREEN[0] >> scale, SCREEN[1] >> scale))
    writes.append((OCTREE_MEMORY, [int(scene.words[0])]))
    writes.append((BOARD_REGISTERS["control"], [period << 8 | scale << 4 | control]))
    boot = encode_list(writes)
    table = np.zeros(TABLE_WORDS, dtype=np.uint32)
    table[: len(boot)] = boot
    steps = orbit_steps(cameras, scene.roots)
    for number, writes in enumerate(steps):
        words = encode_list(writes, end=False)
        start = CAMERAS_WORD + CAMERA_WORDS * number
        table[start : start + len(words)] = words
    return table


def orbit_steps(cameras: Sequence[Camera], roots: Sequence[int]) -> list[Writes]:
    """Give what the board writes at each step of its orbit.

    Every second step of an animation writes the root of a frame in place of a camera: the list of a step has no room
    for both. The animation plays whole times, once or more; of more than 64 frames some are left out.

    Parameters
    ----------
    cameras
        128 of them; an animation takes every second one.
    roots
        Those of the frames; one for a still scene.

    Examples
    --------
    >>> from voxrt.octree.camera import Camera
    >>> steps = orbit_steps([Camera((16 * n, 0, 0), (0, 0, -1), (1, 0, 0), (0, 1, 0)) for n in range(128)], [1, 2, 3])
    >>> steps[1], steps[127]
    ([(120, [1])], [(120, [3])])
    """
    steps = [camera_writes(camera) for camera in cameras]
    if len(roots) > 1:
        half = CAMERAS // 2
        shown = len(roots) * max(1, half // len(roots))  # frames along the orbit
        for number in range(half):
            root = roots[number * shown // half % len(roots)]
            steps[2 * number + 1] = register_writes("root", address=root)
    return steps


def encode_octree(words: NDArray[np.uint32], block_bits: int) -> NDArray[np.uint32]:
    """Give the rows of the octree memory, as ``rtl/memory/voxrt_word_encoder.sv`` makes them of words.

    Parameters
    ----------
    words
        uint32, report dialect, checked; word 0 is in no row.
    block_bits
        The memory holds 2**block_bits blocks.

    Returns
    -------
    ndarray
        uint32, shape (8 * 2**block_bits,); rows beyond the scene are empty space.

    Raises
    ------
    ValueError
        The octree has more words.

    Examples
    --------
    >>> encode_octree(np.array([1, 9, *[0xFFFFFF07] * 15], dtype=np.uint32), 5)[:3].tolist()
    [1, 519, 519]
    """
    return encoded_rows(np.ascontiguousarray(words), block_bits)
