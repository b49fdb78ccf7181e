"""What a core holds when it shows a scene: the contents of its memory, and the writes that start its first frame.

``voxrt convert --form core`` writes these files, for simulations, for block RAMs that are configured with their
contents, and for programs in C. ``docs/first_frame.md`` is the reference.
"""

from __future__ import annotations

import re
import textwrap
from typing import TYPE_CHECKING

import numpy as np

from voxrt.board.designs.boot_table import OCTREE_MEMORY, encode_octree, scene_writes
from voxrt.board.device import Identity
from voxrt.board.register_writes import camera_writes, register_writes
from voxrt.board.view_check import check_view
from voxrt.octree import coarsen
from voxrt.voxelize import DoesNotFitError

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.board.register_writes import Writes
    from voxrt.board.scene import Scene
    from voxrt.board.view import View
    from voxrt.octree import Rom
    from voxrt.rtl.configurations import Configuration

FRAME_LIMIT = 4095
"""Columns and rows of a picture, at most."""

BOOT, HEADER = "boot.hex", "scene.h"
_PRIVATE, _BANKED, _CACHED = range(3)  # MemoryForm
_BANKS = 16
_FIRST_WORD = 7  # of an external memory: word 0 is the last of its line
_OCTREE, _TOP, _BANK_FILES = "octree.hex", "top.hex", tuple(f"bank_{number:02d}.hex" for number in range(_BANKS))
_ROWS = re.compile(rb"([0-9a-f]{3,8}\n)+[0-9a-f]{0,8}")
MEMORY_FILES = (_OCTREE, _TOP, *_BANK_FILES)
"""The contents of block RAMs, in any form of memory."""


def is_memory_file(path: Path) -> bool:
    """Tell whether a file has the form of those of :data:`MEMORY_FILES`: rows of hexadecimal digits. Links have not."""
    if path.is_symlink() or not path.is_file():
        return False
    with path.open("rb") as file:
        return _ROWS.fullmatch(file.read(4096)) is not None


def check_fit(rom: Rom, configuration: Configuration) -> None:
    """Refuse a memory that a configuration of the core cannot hold; the DoesNotFitError has a depth that fits."""
    words, levels, tree = configuration.words, configuration.parameters["MaxDepth"], rom.octree
    if len(tree.words) <= words and tree.depth <= levels:
        return
    fits = next(n for n in range(min(tree.depth, levels), -1, -1) if n == 0 or len(coarsen(tree, n).words) <= words)
    raise DoesNotFitError(
        f"{rom.name}: {len(tree.words):,} words and {tree.depth} levels, and the configuration {configuration.name} "
        f"holds {words:,} words and {levels} levels; build it with --depth {fits}, or with --budget {words}"
    )


def core_files(scene: Scene, view: View, configuration: Configuration) -> dict[str, bytes]:
    """Return the files of a scene for a configuration of the core, by their names.

    They are those of :func:`memory_files`; ``boot.hex``, the writes, each as ADDRESS_DATA, with word 0 of the octree;
    and ``scene.h``, words and writes for C. The scene fits: see :func:`check_fit`. The view is that of the first frame;
    its background is ignored, material 0 of the scene is shown. Refused if the core cannot show the view: it is too
    large or too far away, or needs what is not built in.
    """
    parameters = configuration.parameters
    identity = Identity(
        name=f"the configuration {configuration.name}",
        version="",
        capacity=configuration.words,
        depth=parameters["MaxDepth"],
        size=(FRAME_LIMIT, FRAME_LIMIT),
        position_limit=1 << (parameters["PositionBits"] - 1),
        features=frozenset(configuration.features),
    )
    check_view(view, identity)
    writes = scene_writes(scene, view.lighting, view.size) + camera_writes(view.camera)
    cached = parameters["MemoryForm"] == _CACHED
    start = register_writes("control", start=1, flush=cached)
    first = [] if cached else [(OCTREE_MEMORY, [int(scene.words[0])])]
    boot = [*writes, *first, *start]
    files = memory_files(scene.words, configuration)
    files[BOOT] = "".join(f"{address:08x}_{word:08x}\n" for address, word in each_write(boot)).encode()
    files[HEADER] = _header(scene, view, configuration, [*writes, *start]).encode()
    return files


def each_write(writes: Writes) -> list[tuple[int, int]]:
    """Give the writes one by one: address and word.

    Examples
    --------
    >>> each_write([(0x30, [1, 2])])
    [(48, 1), (52, 2)]
    """
    return [(address + 4 * place, word) for address, words in writes for place, word in enumerate(words)]


def memory_files(words: NDArray[np.uint32], configuration: Configuration) -> dict[str, bytes]:
    r"""Return the contents of an octree memory, by file; rows beyond the scene are empty space.

    Word 0 of the words (report dialect) is in a register of the core, and in no block RAM. Private copies have
    ``octree.hex``, which every copy holds; banks ``bank_00.hex`` to ``bank_15.hex``, and ``top.hex``, which every copy
    of the first blocks holds; an external memory ``octree.hex``, words of 32 bits that are not encoded, from
    ``memory_base``.

    Examples
    --------
    >>> import numpy as np
    >>> from voxrt.rtl.configurations import read_configurations
    >>> leaves = np.array([1, *[0xFFFFFF07] * 8], np.uint32)
    >>> memory_files(leaves, read_configurations()["tiny"])["octree.hex"][:10]
    b'1007\n1007\n'
    """
    block_bits, form = (configuration.parameters[name] for name in ("BlockBits", "MemoryForm"))
    if form == _CACHED:
        image = np.zeros(-(-(_FIRST_WORD + len(words)) // 8) * 8, np.uint32)
        image[_FIRST_WORD : _FIRST_WORD + len(words)] = words
        return {_OCTREE: "".join(f"{word:08x}\n" for word in image.tolist()).encode()}
    rows = encode_octree(words, block_bits)
    if form == _PRIVATE:
        return {_OCTREE: _rows(rows, block_bits)}
    # voxrt_banked_memory: the word in a row of a bank is {row, bank ^ lowest bits of row}.
    row, bank = np.divmod(np.arange(len(rows)), _BANKS)
    banks = rows[_BANKS * row + (bank ^ (row % _BANKS))].reshape(-1, _BANKS)
    top = 8 << (block_bits - 2 if block_bits < 10 else 8)
    files = {name: _rows(banks[:, number], block_bits) for number, name in enumerate(_BANK_FILES)}
    return files | {_TOP: _rows(banks.reshape(-1)[:top], block_bits)}


def _rows(rows: NDArray[np.uint32], block_bits: int) -> bytes:
    digits = -(-(max(block_bits, 9) + 1) // 4)
    return "".join(f"{row:0{digits}x}\n" for row in rows.tolist()).encode()


_HEADER = """\
/* The scene {name} for a core of voxrt, configuration {configuration}: written by `voxrt convert --form core`.
 *
 * Write voxrt_scene_words to the {memory}. Then the pairs of
 * voxrt_scene_writes to the registers, in order: byte address, value. The last one starts the frame.
 */
#ifndef VOXRT_SCENE_H
#define VOXRT_SCENE_H

#include <stdint.h>

#define VOXRT_SCENE_DEPTH {depth}
#define VOXRT_SCENE_WIDTH {width}
#define VOXRT_SCENE_HEIGHT {height}
#define VOXRT_SCENE_WORDS {words}
#define VOXRT_SCENE_WRITES {writes}
#define VOXRT_SCENE_FRAMES {frames}

static const uint32_t voxrt_scene_words[VOXRT_SCENE_WORDS] = {{
{word_rows}
}};

/* What the register root takes to show each frame: one for a still scene. */
static const uint32_t voxrt_scene_roots[VOXRT_SCENE_FRAMES] = {{
{roots}
}};

static const uint32_t voxrt_scene_writes[VOXRT_SCENE_WRITES][2] = {{
{write_rows}
}};

#endif
"""


def _header(scene: Scene, view: View, configuration: Configuration, writes: Writes) -> str:
    words = ", ".join(f"0x{word:08X}" for word in scene.words.tolist())
    pairs = [f"    {{0x{address:03X}, 0x{word:08X}}}," for address, word in each_write(writes)]
    return _HEADER.format(
        name="".join(letter if letter.isalnum() or letter in " -_." else "_" for letter in scene.name),
        configuration=configuration.name,
        memory="external memory: word a to the byte address memory_base + 28 + 4 a"
        if configuration.parameters["MemoryForm"] == _CACHED
        else "memory port: word a to the byte address 4 a",
        depth=scene.depth,
        width=view.size[0],
        height=view.size[1],
        words=len(scene.words),
        writes=len(pairs),
        frames=len(scene.roots),
        roots=textwrap.fill(", ".join(map(str, scene.roots)), 110, initial_indent="    ", subsequent_indent="    "),
        word_rows=textwrap.fill(words, 110, initial_indent="    ", subsequent_indent="    "),
        write_rows="\n".join(pairs),
    )
