"""The exact model as a device."""

from __future__ import annotations

import math
import time
from typing import TYPE_CHECKING

import numpy as np

from voxrt.board.device import Counters, Frame, Identity
from voxrt.board.errors import DeviceError, FrameDropped, TooSlow
from voxrt.board.patch_writes import write_patch
from voxrt.board.view import FEATURES
from voxrt.octree.words import EMPTY
from voxrt.sim import _model

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from voxrt.board.frame_drop import FrameDrop
    from voxrt.board.view import View
    from voxrt.octree import Patch

MODEL_CAPACITY = 1 << 25
"""Words of the model's memory."""

_FRAME_LIMIT = 4095
_PIXEL_SECONDS = 2e-6


class _Memory:
    """Scene memory, material table and selected octree.

    Pages that nothing was written to cost no memory.
    """

    def __init__(self, capacity: int) -> None:
        self.capacity = capacity
        self.colours = np.zeros((256, 3), dtype=np.uint8)
        self.mirrors = np.zeros(256, dtype=np.uint8)
        self.root, self.depth = 0, 1
        self._words = np.zeros(capacity, dtype=np.uint32)
        self._words[0] = EMPTY
        self._end = 1  # of what was written
        self._models: dict[tuple[int, int], _model.Memory] = {}  # of the roots of the words that are there

    def write(self, address: int, words: NDArray[np.uint32]) -> None:
        end = self._check(address, len(words))
        self._models.clear()
        self._words[address:end] = words
        self._end = max(self._end, end)

    def read(self, address: int, count: int) -> NDArray[np.uint32]:
        end = self._check(address, count)
        return self._words[address:end].copy()

    def model(self) -> _model.Memory:
        """Return the selected octree; those of all roots share a copy of the words."""
        key = self.root, self.depth
        if key not in self._models:
            words = self._words[: self._end + (1 - self._end) % 8]
            other = next(iter(self._models.values()), None)
            try:
                self._models[key] = (
                    _model.Memory(words, self.depth, self.root)
                    if other is None
                    else _model.Memory(other, self.depth, self.root)
                )
            except ValueError as error:
                raise DeviceError(f"the model refuses the memory: {error}") from error
        return self._models[key]

    def _check(self, address: int, count: int) -> int:
        if not 0 <= address <= address + count <= self.capacity:
            raise DeviceError(f"words {address} to {address + count} are not in a memory of {self.capacity}")
        return address + count


class ModelDevice:
    """The exact model: the pixels of the hardware, without clock cycles.

    Parameters
    ----------
    threads
        Threads per frame; 0 for one per processor core.
    capacity
        Words of scene memory.
    """

    def __init__(self, *, threads: int = 0, capacity: int = MODEL_CAPACITY) -> None:
        self._identity = Identity(
            name="exact model",
            version="1",
            capacity=capacity,
            depth=16,
            size=(_FRAME_LIMIT, _FRAME_LIMIT),
            position_limit=1 << 31,
            features=frozenset(FEATURES),
            pixel_seconds=_PIXEL_SECONDS,
        )
        self._memory = _Memory(capacity)
        self._view: View | None = None
        self._threads = threads
        self._stopped = False
        self._stop = _model.Stop()  # of the present frame
        self._model = self._memory.model()

    @property
    def identity(self) -> Identity:
        """What it is and what it can hold."""
        return self._identity

    def loaded(self) -> None:
        """Return None: nothing was in the memory."""

    def registers(self) -> Mapping[str, int]:
        """Return what the registers of the hardware would hold."""
        registers = {"root": self._memory.root, "depth": self._memory.depth}
        if self._view is not None:
            registers["width"], registers["height"] = self._view.size
            camera = self._view.camera
            for name in ("position", "look", "right", "up"):
                registers |= {f"{name}_{axis}": value for axis, value in zip("xyz", getattr(camera, name), strict=True)}
            red, green, blue = self._view.background
            registers["background"] = red << 16 | green << 8 | blue
        return registers

    def hold(self) -> None:
        """Do nothing: no frame is in progress between two calls."""

    def write_memory(self, address: int, words: NDArray[np.uint32]) -> None:
        """Write words from word `address` on."""
        self._memory.write(address, words)

    def read_memory(self, address: int, count: int) -> NDArray[np.uint32]:
        """Read `count` words from word `address` on."""
        return self._memory.read(address, count)

    def write_materials(self, colours: NDArray[np.uint8], mirrors: NDArray[np.bool_]) -> None:
        """Write the material table."""
        self._memory.colours, self._memory.mirrors = colours.copy(), mirrors.astype(np.uint8)

    def select_scene(self, root: int, depth: int) -> None:
        """Trace the octree at word `root` from the next frame on."""
        self._memory.root, self._memory.depth = root, depth
        self._model = self._memory.model()

    def apply_patch(self, patch: Patch, depth: int) -> None:
        """Write what an edit changed, and trace its root from the next frame on."""
        write_patch(self, patch, depth)

    def frame(self, view: View, seconds: float = math.inf, drop: FrameDrop | None = None) -> Frame:
        """Render one frame of `view`, with the work of `seconds` of an idle machine, unless it is dropped."""
        started = time.perf_counter()
        stop = self._stop = _model.Stop()
        if self._stopped:  # read after the new object is in place: `stop` may come from another thread at any time
            stop.set()
        if drop is not None:
            drop.call_when_requested(stop.set)
        camera = np.array([view.camera.position, view.camera.look, view.camera.right, view.camera.up], dtype=np.int32)
        try:
            pixels = self._model.render(
                self._colours(view),
                camera,
                *view.size,
                self._threads,
                flat=view.lighting.flat,
                brightness=None if view.lighting.faces is None else np.array(view.lighting.faces, dtype=np.uint8),
                light=np.array(view.lighting.position, dtype=np.int32) if view.lighting.on else None,
                ambient=view.lighting.ambient,
                bounces=view.lighting.bounces,
                mirrors=self._memory.mirrors,
                seconds=seconds,
                stop=stop,
            )
        except TimeoutError as error:
            raise TooSlow(f"the frame takes more work than {seconds:.1f} s of an idle machine do") from error
        except InterruptedError as error:
            if drop is not None and drop.requested and not self._stopped:
                raise FrameDropped from error
            raise DeviceError("the frame was stopped") from error
        except ValueError as error:
            raise DeviceError(f"the model refuses the frame: {error}") from error
        self._view = view
        counters = Counters(view.size[0] * view.size[1], None, None, time.perf_counter() - started)
        return Frame(pixels.colour, counters)

    def stop(self) -> None:
        """End the frame in progress, and all further ones."""
        self._stopped = True
        self._stop.set()

    def close(self) -> None:
        """Do nothing: the model holds no resources."""

    def _colours(self, view: View) -> NDArray[np.uint8]:
        colours = self._memory.colours.copy()
        colours[0] = view.background
        return colours
