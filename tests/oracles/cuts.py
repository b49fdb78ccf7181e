"""One world, many memories: shared or not, with uniform octants left whole or cut down to voxels."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Hashable

    from numpy.typing import NDArray

TAG = 0xFFFFFF00


def memory_of(voxels: NDArray[np.uint8], *, share: bool = True, split: bool = False) -> NDArray[np.uint32]:
    """Give the report-dialect words of a dense world (S, S, S) indexed [x, y, z], S a power of two above 1.

    `share` stores equal blocks once; `split` cuts uniform octants down to single voxels all the same.
    """
    words = [0]
    stored: dict[Hashable, int] = {}

    def shape_of(part: NDArray[np.uint8]) -> Hashable:
        if len(part) == 1 or (not split and np.all(part == part[0, 0, 0])):
            return int(part[0, 0, 0])
        return tuple(shape_of(octant) for octant in octants(part))

    def octants(part: NDArray[np.uint8]) -> list[NDArray[np.uint8]]:
        half = len(part) // 2
        cuts = (slice(0, half), slice(half, None))
        return [part[cuts[i & 1], cuts[i >> 1 & 1], cuts[i >> 2]] for i in range(8)]

    queue: list[tuple[int, Hashable]] = [(0, shape_of(voxels))]
    for address, shape in queue:
        if isinstance(shape, int):
            words[address] = TAG | shape
        elif share and shape in stored:
            words[address] = stored[shape]
        else:
            block = len(words)
            stored[shape] = words[address] = block
            words.extend([0] * 8)
            queue.extend((block + i, octant) for i, octant in enumerate(shape))
    return np.array(words, dtype=np.uint32)
