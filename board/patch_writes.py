"""The writes that give the memory of a device an edit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from voxrt.board.errors import DeviceError
from voxrt.octree.words import move_pointers

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from voxrt.board.device import Device
    from voxrt.octree import Patch


def block_writes(patch: Patch) -> Iterator[tuple[int, NDArray[np.uint32]]]:
    """Give the writes of the blocks of a patch, a run of neighbours each: the address of the first word, and the words.

    Examples
    --------
    >>> from voxrt.octree import Patch
    >>> patch = Patch(41, 9, np.array([9, 17, 33], np.uint32), np.full((3, 8), 0xFFFFFF01, np.uint32))
    >>> [(address, len(words)) for address, words in block_writes(patch)]
    [(9, 16), (33, 8)]
    """
    cuts = np.flatnonzero(np.diff(patch.addresses) != 8) + 1
    for addresses, blocks in zip(np.split(patch.addresses, cuts), np.split(patch.blocks, cuts), strict=True):
        if len(addresses):
            yield int(addresses[0]), blocks.ravel()


def moved_patch(patch: Patch, distance: int) -> Patch:
    """Return a patch for a memory whose words stand `distance` words further."""
    words = move_pointers(np.append(patch.blocks, np.uint32(patch.root_word)), distance)
    addresses = patch.addresses + np.uint32(distance)
    return replace(
        patch,
        root=patch.root + distance,
        root_word=int(words[-1]),
        addresses=addresses,
        blocks=words[:-1].reshape(-1, 8),
    )


def write_patch(device: Device, patch: Patch, depth: int) -> None:
    """Write a patch as :meth:`Device.apply_patch` says, by the other methods of a device."""
    write_blocks(device, patch)
    root = np.array([patch.root_word], np.uint32)
    device.write_memory(patch.root, root)
    check_kept(patch.root, root, device.read_memory(patch.root, 1))
    device.select_scene(patch.root, depth)


def write_blocks(device: Device, patch: Patch) -> None:
    """Write the blocks of a patch, which no frame reads, and read them back; DeviceError where one was not kept."""
    for address, words in block_writes(patch):
        device.write_memory(address, words)
    for address, words in block_writes(patch):
        check_kept(address, words, device.read_memory(address, len(words)))


def check_kept(address: int, expected: NDArray[np.uint32], found: NDArray[np.uint32]) -> None:
    """Compare words that were read back from word `address` on; DeviceError names the first that differs."""
    differing = np.flatnonzero(found != expected)
    if len(differing):
        first = int(differing[0])
        raise DeviceError(
            f"word 0x{address + first:X} reads 0x{int(found[first]):08X} where 0x{int(expected[first]):08X} was "
            "written; upload again, and check the board if that repeats"
        )
