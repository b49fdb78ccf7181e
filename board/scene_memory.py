"""Scenes in a device's memory: one runs, another takes its place, and nothing that breaks on the way shows."""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from .errors import DeviceError, Refused
from .scene import check_memory, relocate

if TYPE_CHECKING:
    from .device import Device
    from .scene import Scene

_BURST = 4096  # words between two reports of progress


class Progress(Protocol):
    """Hears how far a scene has come."""

    def __call__(self, stage: str, done: int, total: int, /) -> None:
        """Hear that `stage` is `done` parts of `total` through."""


class SceneMemory:
    """The memory of one device.

    Where two scenes fit, the new one is written beside the running one and selected when it is complete. Where they do
    not, it is written over the running one, which is restored from this object's copy should anything go wrong.

    Parameters
    ----------
    device
        Called from the thread that calls :meth:`swap`; nobody else calls it meanwhile.
    """

    def __init__(self, device: Device) -> None:
        self._device = device
        self._running: Scene | None = None
        self._base = 0

    @property
    def running(self) -> Scene | None:
        """The scene that frames show."""
        return self._running

    def check(self, scene: Scene) -> None:
        """Refuse a scene that the device cannot hold, or that is malformed; touches nothing.

        Raises
        ------
        Refused
            Too many words, too deep, or no octree.
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
        check_memory(scene.words, scene.depth)

    def swap(self, scene: Scene, progress: Progress) -> None:
        """Write a scene, read it back, and let the next frame show it.

        Raises
        ------
        Refused
            As :meth:`check` does, before the first word.
        DeviceError
            The memory did not keep what was written. The old scene runs on.
        """
        self.check(scene)
        spare = self._spare(len(scene.words))
        base = 0 if spare is None else spare
        try:
            self._write(scene, base, progress)
            self._select(scene, base)
        except BaseException as fault:
            self._restore(overwritten=spare is None, fault=fault)
            raise
        self._running, self._base = scene, base

    def _spare(self, count: int) -> int | None:
        """Find where `count` words fit beside the running scene; None where they do not."""
        if self._running is None or count <= self._base:
            return 0
        if not self._device.identity.movable_root:
            return None
        behind = -(-(self._base + len(self._running.words)) // 8) * 8
        return behind if behind + count <= self._device.identity.capacity else None

    def _write(self, scene: Scene, base: int, progress: Progress) -> None:
        words = relocate(scene.words, base)
        for start in range(0, len(words), _BURST):
            progress("write", start, len(words))
            self._device.write_memory(base + start, words[start : start + _BURST])
        for start in range(0, len(words), _BURST):
            progress("verify", start, len(words))
            wanted = words[start : start + _BURST]
            found = self._device.read_memory(base + start, len(wanted))
            differs = np.flatnonzero(found != wanted)
            if len(differs):
                at = int(differs[0])
                raise DeviceError(
                    f"word 0x{base + start + at:X} reads 0x{int(found[at]):08X} where 0x{int(wanted[at]):08X} was "
                    "written; upload again, and check the board if that repeats"
                )
        progress("verify", len(words), len(words))

    def _select(self, scene: Scene, base: int) -> None:
        self._device.write_materials(scene.colours, scene.mirrors)
        self._device.select_scene(base, scene.depth)

    def _restore(self, *, overwritten: bool, fault: BaseException) -> None:
        if self._running is None:
            return
        try:
            if overwritten:
                self._write(self._running, self._base, lambda _stage, _done, _total: None)
            self._select(self._running, self._base)
        except DeviceError as second:
            raise DeviceError(f"{fault}; and the old scene could not be restored: {second}") from fault
