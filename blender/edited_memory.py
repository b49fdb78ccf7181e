"""The memory of a scene whose objects are edited one at a time.

Only the voxels around an edited object are made again. They are those of a whole build but where a face lies on a plane
between voxels to the last bit of its coordinates. What leaves the grid is cut off. So the whole scene is built again
when its author rests.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

import voxrt
from voxrt.octree import Octree, Piece, World, build
from voxrt.voxelize import BoxCollider, Grid, voxelize
from voxrt.voxelize.collider_shapes import bounding_points

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.octree import Patch
    from voxrt.voxelize import Material, Scene, SceneObject

_MARGIN = 1  # voxels around an object's box: boxes are of rounded numbers
_FARTHEST = 1 << 17  # voxels from the grid's corner: the voxelizer takes no more than twice as many


class EditedMemory:
    """A scene with its memory. `result` is what the whole scene was built to, by `options`."""

    def __init__(self, scene: Scene, result: voxrt.BuildResult, options: voxrt.BuildOptions) -> None:
        assert result.rom.grid is not None
        self._scene = scene
        self._options = options
        self._grid = result.rom.grid
        self._start = result.rom
        self._world = World(result.rom, undo_steps=0)
        self._root_word = int(result.rom.octree.words[0])
        self._boxes = np.array([self._box(one) for one in scene.objects])
        self._numbers = {one.name: number for number, one in enumerate(scene.objects)}
        self._palette = len(scene.materials) == len(result.rom.materials)

    def replaced(self, item: SceneObject, materials: tuple[Material, ...]) -> bool:
        """Put an object in the place of that of its name. False, and no change, where the whole must be built again."""
        number = self._numbers.get(item.name)
        options = self._options
        if number is None or not self._palette or options.bake or options.budget or options.fill == "together":
            return False
        # What other rules keep of thin parts depends on their neighbours.
        if {options.rule, item.rule or "touch", *(one.rule or "touch" for one in self._scene.objects)} != {"touch"}:
            return False
        box = self._box(item)
        low = np.minimum(self._boxes[number, 0], box[0])
        high = np.maximum(self._boxes[number, 1], box[1])
        if max(-box.min(), box.max()) > _FARTHEST:
            return False
        low, high = np.maximum(low, 0), np.minimum(high, self._grid.size)
        boxes = self._boxes.copy()
        boxes[number] = box
        objects = list(self._scene.objects)
        objects[number] = item
        near = np.flatnonzero((boxes[:, 0] < high).all(axis=1) & (boxes[:, 1] > low).all(axis=1))
        # Their corners go to multiples of powers of two of the whole grid.
        if any(isinstance(one, BoxCollider) for row in near for one in objects[row].colliders):
            return False
        scene = replace(self._scene, objects=tuple(objects), materials=(self._scene.materials[0], *materials[1:]))
        if (low < high).all():
            self._make(replace(scene, objects=tuple(objects[row] for row in near)), low, high)
        self._scene, self._boxes = scene, boxes
        return True

    def commit(self) -> Patch:
        """Make the voxels as they are those of :meth:`rom`; return what memories with the last ones must write."""
        last = self._world.live_roots
        patch = self._world.commit()
        for root in last:
            if root != patch.root:
                self._world.release(root)
        self._root_word = patch.root_word
        return patch

    def rom(self) -> voxrt.Rom:
        """Return the memory of the last commit. Its free blocks are in it, too: a whole build has fewer words."""
        words = self._world.image.copy()
        words[0] = self._root_word
        return replace(self._start, octree=Octree(self._grid.depth, words), materials=self._world.materials)

    def _make(self, scene: Scene, low: NDArray[np.int64], high: NDArray[np.int64]) -> None:
        """Make the voxels of a box again, of a scene with the objects that reach into it."""
        depth = max(1, int(np.ceil(np.log2((high - low).max()))))
        origin = np.array(self._grid.origin) + low * self._grid.voxel_size
        grid = Grid(depth, tuple(origin.tolist()), self._grid.voxel_size)
        options = self._options
        made = voxelize(
            scene,
            grid,
            fill=options.fill_per_object,
            rule=options.rule,
            thin=options.thin,
            geometry=options.geometry,
            pow2=options.pow2,
            threads=options.threads,
        )
        corner = tuple(low.tolist())
        self._world.fill(voxrt.Box(corner, tuple(high.tolist())), 0)
        self._world.paste(Piece(build(made.voxels), tuple((high - low).tolist()), scene.materials), corner)

    def _box(self, item: SceneObject) -> NDArray[np.int64]:
        """Return the lowest voxel of an object, and one behind its highest: int64, shape (2, 3)."""
        points = np.concatenate([item.mesh.positions, *map(bounding_points, item.colliders)])
        placed = points @ item.transform[:3, :3].T + (item.transform[:3, 3] - self._grid.origin)
        low, high = placed.min(axis=0) / self._grid.voxel_size, placed.max(axis=0) / self._grid.voxel_size
        return np.array([np.floor(low) - _MARGIN, np.ceil(high) + _MARGIN]).astype(np.int64)
