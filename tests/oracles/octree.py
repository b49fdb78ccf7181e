"""An octree built the slow, obvious way, and voxels cut in arbitrary ways: nothing here is shared with the product."""

import numpy as np

from voxrt.voxelize import Voxels

TAG = 0xFFFFFF00


def reference_words(dense):
    """Memory words of a dense cube (side a power of two, indexed [x, y, z]): nested tuples, then breadth-first."""

    def tree(cube):
        if (cube == cube.flat[0]).all():
            return TAG | int(cube.flat[0])
        h = len(cube) // 2
        return tuple(tree(cube[x : x + h, y : y + h, z : z + h]) for z in (0, h) for y in (0, h) for x in (0, h))

    root = tree(np.asarray(dense))
    order, address = [], {}

    def word(node):
        if isinstance(node, int):
            return node
        if node not in address:
            address[node] = 1 + 8 * len(order)
            order.append(node)
        return address[node]

    words = [word(root)]
    for node in order:  # grows while it is walked
        words += [word(child) for child in node]
    return np.array(words, dtype=np.uint32)


def unshared_words(dense):
    """The same octree depth-first and without sharing: valid, not canonical."""
    words = [0]

    def place(cube, at):
        if (cube == cube.flat[0]).all():
            words[at] = TAG | int(cube.flat[0])
            return
        first = len(words)
        words[at] = first
        words.extend([0] * 8)
        h = len(cube) // 2
        octants = [(x, y, z) for z in (0, h) for y in (0, h) for x in (0, h)]
        for i, (x, y, z) in enumerate(octants):
            place(cube[x : x + h, y : y + h, z : z + h], first + i)

    place(np.asarray(dense), 0)
    return np.array(words, dtype=np.uint32)


def walk(words, depth, point):
    """The material of one voxel, word by word; 0 outside the world."""
    if not all(0 <= c < 2**depth for c in point):
        return 0
    word = int(words[0])
    level = depth
    while not word >> 31:
        level -= 1
        x, y, z = (int(c) >> level & 1 for c in point)
        word = int(words[word + (4 * z + 2 * y + x)])
    return word & 0xFF


def morton(x, y, z, bits=16):
    return sum((x >> k & 1) << 3 * k | (y >> k & 1) << 3 * k + 1 | (z >> k & 1) << 3 * k + 2 for k in range(bits))


def cut_up(dense, corner, level, choose):
    """Yield the octants and bricks that make up an octant of `dense`, in Morton order: (level, code, voxels)."""
    side = 1 << level
    cube = dense[tuple(slice(c, c + side) for c in corner)]
    if not cube.any():
        return
    if level >= 3 and (cube == cube.flat[0]).all() and not choose():
        yield level, morton(*corner) >> 3 * level, cube
    elif level <= 3:
        yield 0, morton(*corner) >> 9, cube
    else:
        for i in range(8):
            child = tuple(c + (i >> axis & 1) * side // 2 for axis, c in enumerate(corner))
            yield from cut_up(dense, child, level - 1, choose)


def voxels_from_dense(dense, choose=lambda: False):
    """Voxels of a dense cube; `choose()` says, each time it matters, whether to take the less obvious form."""
    depth = len(dense).bit_length() - 1
    parts = list(cut_up(np.asarray(dense), (0, 0, 0), depth, choose))
    bricks = [(code, cube) for level, code, cube in parts if level == 0]
    octants = [(code, level, cube.flat[0]) for level, code, cube in parts if level > 0]
    masks = np.zeros((len(bricks), 8), np.uint64)
    materials = np.zeros(len(bricks), np.uint8)
    rows = np.full(len(bricks), -1, np.int32)
    cells = []
    for i, (_, cube) in enumerate(bricks):
        flat = np.zeros(512, np.uint8)
        for x, y, z in np.argwhere(cube):
            j = morton(int(x), int(y), int(z), 3)
            flat[j] = cube[x, y, z]
            masks[i, j // 64] |= np.uint64(1 << (j % 64))
        solid = np.unique(flat[flat > 0])
        if len(solid) == 1 and not choose():
            materials[i] = solid[0]
        else:
            rows[i] = len(cells)
            cells.append(flat)
    return Voxels(
        depth=depth,
        brick_codes=np.array([b[0] for b in bricks], np.uint64),
        brick_masks=masks,
        brick_materials=materials,
        brick_rows=rows,
        cells=np.array(cells, np.uint8).reshape(-1, 512),
        octant_codes=np.array([o[0] for o in octants], np.uint64),
        octant_levels=np.array([o[1] for o in octants], np.uint8),
        octant_materials=np.array([o[2] for o in octants], np.uint8),
    )
