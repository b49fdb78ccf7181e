"""Scenes in the memory of a device: how the next one is loaded while frames show the present one."""

from __future__ import annotations

import zlib
from typing import TYPE_CHECKING, Protocol

import numpy as np
from msgspec.structs import replace

from voxrt.board.edited_scene import rom_of, same_materials, with_numbers
from voxrt.board.errors import DeviceError, Refused
from voxrt.board.loaded_scene import LoadedScene, cut_out
from voxrt.board.patch_writes import check_kept, moved_patch
from voxrt.board.scene import check_memory, check_size
from voxrt.octree import Box, World
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
_ROOM = 1 << 21  # words before a scene at the end of the memory that its edits may use
_PATCH_LIMIT = 1 << 19  # words of both scenes: they are compared in one step, in which no frame comes


class Progress(Protocol):
    """Receives the progress of a scene that is being loaded."""

    def __call__(self, stage: str, done: int, total: int, /) -> None:
        """Receive that `done` of `total` parts of `stage` are complete."""


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
        self._shown = loaded is None or loaded.shown
        self._just_read = loaded is not None
        self._world: World | None = None  # whose image the memory holds
        self._root = 0  # of the world: what frames show
        self._in_doubt = False  # whether the memory holds the blocks of the world
        self._placed: tuple[World | None, int] = None, 0  # the last world that was made, and where its word 0 is

    @property
    def loaded(self) -> Scene | None:
        """The scene in the memory; one that was edited, or loaded as a patch, with its free blocks."""
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
        check_size(scene, identity.name, identity.capacity, identity.depth)

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

    def world_of(self, scene: Scene, *, undo_steps: int = 100) -> World:
        """Return a world of the loaded scene, for :meth:`begin_edits`.

        Its blocks are where the memory has them, if it has equal ones once, and all others are free.

        Parameters
        ----------
        scene
            The loaded one, or one that differs from it in names and materials.
        undo_steps
            As :class:`voxrt.octree.World` has it.
        """
        root, offset = None, 0
        if self._scene is not None:
            words, root, offset = self._image()
            scene = replace(scene, words=words)
        capacity = self._device.identity.capacity
        world = World(rom_of(scene), words=capacity - offset, undo_steps=undo_steps, root=root)
        self._placed = world, offset
        return world

    def begin_edits(self, world: World, scene: Scene) -> None:
        """Give the memory all words of a world; from then on :meth:`show_edits` writes what changes.

        What the memory holds is compared with the world: it is written, while the device is held, only where it
        differs. So a host that connects again goes on with its world.

        Parameters
        ----------
        world
            That of :meth:`world_of`, or another one, whose word 0 is then word 0 of the memory. Nobody else commits it
            or releases its roots. Its newest live root is shown.
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
        offset = self._base if world is self._world else 0
        if world is self._placed[0]:
            offset = self._placed[1]
        if self._holds(world, edited.words, offset):
            self._select(edited, offset)
        else:
            self._overwrite(edited, _ignore, None)
            offset = 0
        self._keep(LoadedScene(scene, offset))
        self._placed = world, offset
        self._world, self._root = world, root

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
            if self._base + patch.end > self._device.identity.capacity:
                raise Refused(f"the edit leads beyond the {self._device.identity.capacity} words of the device")
            if not same_materials(scene, before):
                self._device.write_materials(scene.colours, scene.mirrors)
            self._device.apply_patch(moved_patch(patch, self._base), scene.depth)
            self._scene, self._root, self._in_doubt = scene, patch.root, False
        for root in older:
            if root != patch.root:
                world.release(root)
        return len(patch.addresses)

    def _image(self) -> tuple[NDArray[np.uint32], int, int]:
        """Return words of the memory, the address of the root among them, and where the first of them is.

        They are all that the scene uses, and some before it.
        """
        assert self._scene is not None
        if self._world is not None:
            words = self._world.image.copy()
            words[0] = words[self._root]
            return words, self._root, self._base
        offset = max(0, self._base - _ROOM) // 8 * 8
        return *LoadedScene(self._scene, self._base - offset).image(), offset

    def _holds(self, world: World, image: NDArray[np.uint32], offset: int) -> bool:
        """Whether the memory has the live words of a world: as this object knows, or as it reads."""
        root = world.live_roots[-1]
        live = np.append(world.written[:, None] + np.arange(8, dtype=np.uint32), np.uint32(root))
        if self._scene is not None and self._shown and self._world is None:
            words, present, start = self._image()
            known = (start, present) == (offset, root) and live.max() < len(words)
            if known and np.array_equal(words[live], image[live]):
                return True
        found = self._device.read_memory(offset, len(image))
        return zlib.crc32(found[live].tobytes()) == zlib.crc32(move_pointers(image, offset)[live].tobytes())

    def _load_patch(self, scene: Scene, try_scene: Callable[[], None] | None) -> bool:
        """Show a scene that has most blocks of the present one. False where another does; then nothing was written."""
        before, world = self._scene, self._world_to_patch(scene)
        if before is None or world is None:
            return False
        try:
            world.fill(Box((0, 0, 0), (world.size,) * 3), 0)
            world.paste(rom_of(with_numbers(scene)), (0, 0, 0))
        except DoesNotFitError:
            return False
        patch, offset = world.commit(), self._placed[1]
        same = not len(patch.addresses) and same_materials(scene, before) and not self._just_read
        if same or _PATCH_PART * patch.words > len(scene.words):
            return False  # who loads a scene again wants it written again
        try:
            self._device.write_materials(scene.colours, scene.mirrors)
            self._device.apply_patch(moved_patch(patch, offset), scene.depth)
            # A serial board takes its cameras with this, and keeps the materials in the list that it shows again.
            self._device.write_materials(scene.colours, scene.mirrors)
            self._device.select_scene(offset + patch.root, scene.depth)
            if try_scene is not None:
                try_scene()
        except BaseException as error:
            self._in_doubt = self._world is not None  # the patch was written where that has steps of undo
            self._restore(error, overwritten=False)
            raise
        self._keep(cut_out(move_pointers(world.image, offset), offset, offset + patch.root, scene))
        return True

    def _world_to_patch(self, scene: Scene) -> World | None:
        """Return a world that has the words of the present scene, where they may be most of a scene."""
        present = self._scene
        if present is None or self._in_doubt or present.depth != scene.depth or scene.roots != (0,):
            return None
        if len(present.roots) > 1 or len(present.words) + len(scene.words) > _PATCH_LIMIT:
            return None
        world = self.world_of(with_numbers(present), undo_steps=0)
        return world if np.array_equal(world.image, self._image()[0]) else None

    def _free_base(self, count: int) -> int | None:
        """Find where `count` words fit beside the loaded scene: before it, or at the end of the memory.

        Scenes stand at either end of the memory, so the free part is in one piece: two scenes fit whenever their sizes
        allow it.
        """
        if self._scene is None:
            return None
        first, end = self._base, self._base + len(self._scene.words)
        if self._world is not None:
            used = np.append(self._world.written, np.uint32(self._root))
            first, end = first + int(used.min()), first + int(used.max()) + 8
        if count <= first:
            return 0
        last = (self._device.identity.capacity - count) // 8 * 8
        return last if last >= end else None

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
        self._keep(LoadedScene(scene, base))

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
        self._keep(LoadedScene(scene, 0))

    def _keep(self, loaded: LoadedScene) -> None:
        """Take over what the memory holds now."""
        self._scene, self._base, self._shown = loaded.scene, loaded.base, loaded.shown
        self._just_read, self._world, self._in_doubt = False, None, False

    def _select(self, scene: Scene, base: int) -> None:
        self._device.write_materials(scene.colours, scene.mirrors)
        self._select_root(scene, base, 0)

    def _select_root(self, scene: Scene, base: int, frame: int) -> None:
        self._device.select_scene(base + scene.roots[frame], scene.depth)

    def _restore(self, error: BaseException, *, overwritten: bool) -> None:
        try:
            loaded = self.loaded
            if loaded is None or not self._shown:
                self._scene = None
                self._device.write_memory(0, np.array([EMPTY], dtype=np.uint32))
                self._device.select_scene(0, 1)
                return
            if overwritten:
                for _ in self._transfer(loaded, self._base, _ignore):
                    pass
            self._select(loaded, self._base)
        except DeviceError as second:
            raise DeviceError(f"{error}; and the present scene could not be restored: {second}") from error


def _ignore(_stage: str, _done: int, _total: int) -> None:
    pass
