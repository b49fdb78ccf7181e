"""Scenes in the memory of a device: how the next one is loaded while frames show the present one."""

from __future__ import annotations

import zlib
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Protocol

import numpy as np

from voxrt.board.edited_scene import rom_of
from voxrt.board.errors import DeviceError, Refused
from voxrt.board.patch_writes import check_kept
from voxrt.board.scene import check_memory
from voxrt.octree import Box, Patch, World
from voxrt.octree.words import EMPTY, move_pointers
from voxrt.voxelize import DoesNotFitError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from numpy.typing import NDArray

    from voxrt.board.device import Device
    from voxrt.board.scene import Scene

_BURST = 4096  # words per step, at least
_STEPS = 256  # to write a scene, at most: a frame may come between two
_PATCH_PART = 4  # a patch has a word per so many of the scene, at most
_PATCH_LIMIT = 1 << 20  # words of both scenes: they are compared in one step, 0.2 s at most
_IDS = tuple(str(number) for number in range(256))  # names, so that worlds keep the numbers of materials
_BLACK, _DULL = np.zeros((256, 3), np.uint8), np.zeros(256, np.bool_)


class Progress(Protocol):
    """Receives the progress of a scene that is being loaded."""

    def __call__(self, stage: str, done: int, total: int, /) -> None:
        """Receive that `done` of `total` parts of `stage` are complete."""


@dataclass(frozen=True, eq=False, slots=True)
class LoadedScene:
    """A scene in the memory of a device.

    Attributes
    ----------
    scene
        Its words count from its own word 0.
    base
        The word of the memory where the scene's word 0 is.
    """

    scene: Scene
    base: int


class SceneMemory:
    """The memory of one device.

    Where two scenes fit, the new one is written to the part of the memory that the present one does not use. Then its
    materials, depth and root are written while the device is held: frames show either scene, and never a mixture.

    A scene that has most blocks of the present one is written as a patch: see :class:`voxrt.octree.Patch`.

    Where two scenes do not fit, the device is held while the new one replaces the present one. If that fails, the
    present one is written again from this object's copy.

    Parameters
    ----------
    device
        No other caller uses it while a method or a step runs.
    loaded
        The scene that the device shows already.
    """

    def __init__(self, device: Device, loaded: LoadedScene | None = None) -> None:
        self._device = device
        self._scene = loaded.scene if loaded else None
        self._base = loaded.base if loaded else 0
        self._world: World | None = None  # whose image the memory holds
        self._root = 0  # of the world: what frames show
        self._in_doubt = False  # whether the memory holds the last patch
        self._loads: World | None = None  # the world of scenes that were loaded by patches

    @property
    def loaded(self) -> Scene | None:
        """The scene that frames show; an edited one with its free blocks."""
        if self._world is None or self._scene is None:
            return self._scene
        return replace(self._scene, words=self._world.image, roots=(self._root,))

    def check(self, scene: Scene) -> None:
        """Refuse a scene that the device cannot hold, or that is malformed; nothing is written.

        Raises
        ------
        Refused
            The scene has too many words or levels, or its words are no octree.
        """
        self._check_size(scene)
        check_memory(scene.words, scene.depth, scene.roots)

    def _check_size(self, scene: Scene) -> None:
        identity = self._device.identity
        if len(scene.words) > identity.capacity:
            raise Refused(
                f"{scene.name} has {len(scene.words)} words and {identity.name} holds {identity.capacity}; "
                "build it with a smaller depth"
            )
        if scene.depth > identity.depth:
            raise Refused(
                f"{scene.name} has {scene.depth} levels and {identity.name} takes {identity.depth}; "
                "build it with a smaller depth"
            )

    def select_frame(self, number: int) -> None:
        """Show a frame of the loaded scene's animation from the next frame of the device on: one register write.

        Raises
        ------
        Refused
            It has no such frame.
        """
        frames = 1 if self._scene is None else len(self._scene.roots)
        if not 0 <= number < frames:
            raise Refused(f"there is no frame {number}; the scene has {frames}, counted from 0")
        if self._world is None and self._scene is not None:  # an edited scene has one frame, which is selected
            self._select_root(self._scene, self._base, number)

    def load(self, scene: Scene, progress: Progress) -> None:
        """Write a scene, read it back, and show it from the next frame on.

        Raises
        ------
        Refused
            As :meth:`check`; nothing was written.
        DeviceError
            The memory did not keep what was written. The present scene stays.
        """
        for _ in self.load_in_steps(scene, progress):
            pass

    def load_in_steps(
        self, scene: Scene, progress: Progress, try_scene: Callable[[], None] | None = None
    ) -> Iterator[None]:
        """Do what :meth:`load` does in steps; frames may be rendered between two steps.

        These frames show the present scene. The new one is shown after the last step. A caller that stops before it
        leaves the present scene as it is. Where two scenes do not fit there is one step only.

        `try_scene` is called in the last step, when frames show the new scene. If it raises an error, the present
        scene stays, and the error is raised again.

        Raises
        ------
        Refused, DeviceError
            As :meth:`load`.
        """
        self.check(scene)
        if self._load_patch(scene, try_scene):
            return
        base = self._free_base(len(scene.words))
        if base is None:
            self._overwrite(scene, progress, try_scene)
            return
        for _ in self._transfer(scene, base, progress):
            yield
        self._switch(scene, base, try_scene)

    def begin_edits(self, world: World, scene: Scene) -> None:
        """Give the memory all words of a world, from word 0 on; from then on :meth:`show_edits` writes what changes.

        What the memory holds is compared with the world: it is written, while the device is held, only where it
        differs. So a host that connects again goes on with its world.

        Parameters
        ----------
        world
            Nobody else commits it or releases its roots. Its newest live root is shown.
        scene
            Its name, materials and depth; its words are not used.

        Raises
        ------
        Refused
            The device cannot hold the world; nothing was written.
        DeviceError
            The memory did not keep what was written. The present scene stays.
        """
        root = world.live_roots[-1]
        edited = replace(scene, words=world.image, roots=(root,))
        self._check_size(edited)
        if self._holds(world, edited.words):
            self._select(edited, 0)
        else:
            self._overwrite(edited, _ignore, None)
        self._scene, self._base, self._world, self._root, self._in_doubt = scene, 0, world, root, False

    def show_edits(self, scene: Scene) -> int:
        """Show the world that was begun, as it is now, from the next frame on; return the blocks that were written.

        Frames go on meanwhile. Roots that no frame reads any more are released. After an error the next call does what
        :meth:`begin_edits` does.

        Parameters
        ----------
        scene
            As for :meth:`begin_edits`.

        Raises
        ------
        Refused, DeviceError
            As :meth:`begin_edits`; frames show what they did before.
        """
        world, before = self._world, self._scene
        if world is None or before is None:
            raise Refused("no world was begun; begin its edits first")
        older, patch = world.live_roots, world.commit()
        if self._in_doubt:
            self.begin_edits(world, scene)
        else:
            self._in_doubt = True
            if patch.end > self._device.identity.capacity:
                raise Refused(f"the edit leads beyond the {self._device.identity.capacity} words of the device")
            if not _same_materials(scene, before):
                self._device.write_materials(scene.colours, scene.mirrors)
            self._device.apply_patch(patch, scene.depth)
            self._scene, self._root, self._in_doubt = scene, patch.root, False
        for root in older:
            if root != patch.root:
                world.release(root)
        return len(patch.addresses)

    def _holds(self, world: World, image: NDArray[np.uint32]) -> bool:
        """Whether the memory has the live words of a world from word 0 on: as this object knows, or as it reads."""
        loaded = self._scene if self._world is None and self._base == 0 else None
        if loaded is not None and np.array_equal(loaded.words, image):
            return True
        live = np.append(world.written[:, None] + np.arange(8, dtype=np.uint32), np.uint32(world.live_roots[-1]))
        found = self._device.read_memory(0, len(image))
        return zlib.crc32(found[live].tobytes()) == zlib.crc32(image[live].tobytes())

    def _load_patch(self, scene: Scene, try_scene: Callable[[], None] | None) -> bool:
        """Show a scene that has most blocks of the present one. False where another does; then nothing was written."""
        world = self._world_of_loads(scene)
        if world is None:
            return False
        self._loads = None
        try:
            world.fill(Box((0, 0, 0), (world.size,) * 3), 0)
            world.paste(rom_of(replace(scene, names=_IDS, colours=_BLACK, mirrors=_DULL)), (0, 0, 0))
        except DoesNotFitError:
            return False
        older, patch = world.live_roots, world.commit()
        same = not len(patch.addresses) and _same_materials(scene, self._scene)
        if same or _PATCH_PART * patch.words > len(scene.words):
            return False  # who loads a scene again wants it written again
        try:
            self._device.write_materials(scene.colours, scene.mirrors)
            self._device.apply_patch(_moved(patch, self._base), scene.depth)
            self._device.select_scene(self._base + patch.root, scene.depth)  # a serial board takes its cameras with it
            if try_scene is not None:
                try_scene()
        except BaseException as error:
            self._restore(error, overwritten=False)
            raise
        self._scene, self._world, self._root, self._loads = scene, world, patch.root, world
        for root in older:
            if root != patch.root:
                world.release(root)
        return True

    def _world_of_loads(self, scene: Scene) -> World | None:
        """Return a world that has the words of the present scene, where they may be most of a scene."""
        present = self._scene
        if present is None or self._in_doubt or present.depth != scene.depth or scene.roots != (0,):
            return None
        if len(present.words) + len(scene.words) > _PATCH_LIMIT:
            return None
        if self._world is not None:
            return self._world if self._world is self._loads else None
        if present.roots != (0,):
            return None
        memory = rom_of(replace(present, names=_IDS, colours=_BLACK, mirrors=_DULL))
        world = World(memory, words=self._device.identity.capacity - self._base, undo_steps=0)
        return world if np.array_equal(world.image, present.words) else None

    def _free_base(self, count: int) -> int | None:
        """Find where `count` words fit beside the loaded scene: before it, or at the end of the memory.

        Scenes stand at either end of the memory, so the free part is in one piece: two scenes fit whenever their sizes
        allow it.
        """
        loaded = self.loaded
        if loaded is None:
            return None
        if count <= self._base:
            return 0
        last = (self._device.identity.capacity - count) // 8 * 8
        return last if last >= self._base + len(loaded.words) else None

    def _transfer(self, scene: Scene, base: int, progress: Progress) -> Iterator[None]:
        words = move_pointers(scene.words, base)
        burst = max(_BURST, -(-len(words) // _STEPS))
        for start in range(0, len(words), burst):
            progress("write", start, len(words))
            self._device.write_memory(base + start, words[start : start + burst])
            yield
        for start in range(0, len(words), burst):
            progress("verify", start, len(words))
            expected = words[start : start + burst]
            check_kept(base + start, expected, self._device.read_memory(base + start, len(expected)))
            yield
        progress("verify", len(words), len(words))

    def _switch(self, scene: Scene, base: int, try_scene: Callable[[], None] | None) -> None:
        try:
            self._select(scene, base)
            if try_scene is not None:
                try_scene()
        except BaseException as error:
            self._restore(error, overwritten=False)
            raise
        self._scene, self._base, self._world = scene, base, None

    def _overwrite(self, scene: Scene, progress: Progress, try_scene: Callable[[], None] | None) -> None:
        try:
            self._device.hold()
            for _ in self._transfer(scene, 0, progress):
                pass
            self._select(scene, 0)
            if try_scene is not None:
                try_scene()
        except BaseException as error:
            self._restore(error, overwritten=True)
            raise
        self._scene, self._base, self._world = scene, 0, None

    def _select(self, scene: Scene, base: int) -> None:
        self._device.write_materials(scene.colours, scene.mirrors)
        self._select_root(scene, base, 0)

    def _select_root(self, scene: Scene, base: int, frame: int) -> None:
        self._device.select_scene(base + scene.roots[frame], scene.depth)

    def _restore(self, error: BaseException, *, overwritten: bool) -> None:
        try:
            loaded = self.loaded
            if loaded is None:
                self._device.write_memory(0, np.array([EMPTY], dtype=np.uint32))
                self._device.select_scene(0, 1)
                return
            if overwritten:
                for _ in self._transfer(loaded, self._base, _ignore):
                    pass
            self._select(loaded, self._base)
        except DeviceError as second:
            raise DeviceError(f"{error}; and the present scene could not be restored: {second}") from error


def _same_materials(scene: Scene, other: Scene | None) -> bool:
    return (
        other is not None
        and np.array_equal(scene.colours, other.colours)
        and np.array_equal(scene.mirrors, other.mirrors)
    )


def _moved(patch: Patch, base: int) -> Patch:
    """Return a patch for a memory whose word 0 stands at word `base`."""
    words = move_pointers(np.append(patch.blocks, np.uint32(patch.root_word)), base)
    return Patch(patch.root + base, int(words[-1]), patch.addresses + np.uint32(base), words[:-1].reshape(-1, 8))


def _ignore(_stage: str, _done: int, _total: int) -> None:
    pass
