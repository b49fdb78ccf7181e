"""Scenes in the memory of a device: how the next one is loaded while frames show the present one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from voxrt.board.errors import DeviceError, Refused
from voxrt.board.scene import check_memory
from voxrt.octree.words import EMPTY, move_pointers

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from voxrt.board.device import Device
    from voxrt.board.scene import Scene

_BURST = 4096  # words per step, at least
_STEPS = 256  # to write a scene, at most: a frame may come between two


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
        self._loaded = loaded.scene if loaded else None
        self._base = loaded.base if loaded else 0

    @property
    def loaded(self) -> Scene | None:
        """The scene that frames show."""
        return self._loaded

    def check(self, scene: Scene) -> None:
        """Refuse a scene that the device cannot hold, or that is malformed; nothing is written.

        Raises
        ------
        Refused
            The scene has too many words or levels, or its words are no octree.
        """
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
        check_memory(scene.words, scene.depth, scene.roots)

    def select_frame(self, number: int) -> None:
        """Show a frame of the loaded scene's animation from the next frame of the device on: one register write.

        Raises
        ------
        Refused
            It has no such frame.
        """
        frames = 1 if self._loaded is None else len(self._loaded.roots)
        if not 0 <= number < frames:
            raise Refused(f"there is no frame {number}; the scene has {frames}, counted from 0")
        if self._loaded is not None:
            self._select_root(self._loaded, self._base, number)

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
        base = self._free_base(len(scene.words))
        if base is None:
            self._overwrite(scene, progress, try_scene)
            return
        for _ in self._transfer(scene, base, progress):
            yield
        self._switch(scene, base, try_scene)

    def _free_base(self, count: int) -> int | None:
        """Find where `count` words fit beside the loaded scene: before it, or at the end of the memory.

        Scenes stand at either end of the memory, so the free part is in one piece: two scenes fit whenever their sizes
        allow it.
        """
        if self._loaded is None:
            return None
        if count <= self._base:
            return 0
        last = (self._device.identity.capacity - count) // 8 * 8
        return last if last >= self._base + len(self._loaded.words) else None

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
            found = self._device.read_memory(base + start, len(expected))
            differing = np.flatnonzero(found != expected)
            if len(differing):
                first = int(differing[0])
                raise DeviceError(
                    f"word 0x{base + start + first:X} reads 0x{int(found[first]):08X} where "
                    f"0x{int(expected[first]):08X} was written; upload again, and check the board if that repeats"
                )
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
        self._loaded, self._base = scene, base

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
        self._loaded, self._base = scene, 0

    def _select(self, scene: Scene, base: int) -> None:
        self._device.write_materials(scene.colours, scene.mirrors)
        self._select_root(scene, base, 0)

    def _select_root(self, scene: Scene, base: int, frame: int) -> None:
        self._device.select_scene(base + scene.roots[frame], scene.depth)

    def _restore(self, error: BaseException, *, overwritten: bool) -> None:
        try:
            if self._loaded is None:
                self._device.write_memory(0, np.array([EMPTY], dtype=np.uint32))
                self._device.select_scene(0, 1)
                return
            if overwritten:
                for _ in self._transfer(self._loaded, self._base, lambda _stage, _done, _total: None):
                    pass
            self._select(self._loaded, self._base)
        except DeviceError as second:
            raise DeviceError(f"{error}; and the present scene could not be restored: {second}") from error
