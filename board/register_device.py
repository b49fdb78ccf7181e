"""The driver of the ray tracer: registers, memory port and video stream as a :class:`~.device.Device`.

A scene is written to a free part of the memory while frames show another one. It appears by a write of the register
``root`` between two frames.
"""

from __future__ import annotations

import math
import threading
import time
from typing import TYPE_CHECKING, Protocol

import numpy as np

from voxrt.board.device import Counters, Frame, Identity
from voxrt.board.errors import DeviceError, FrameDropped, TooSlow
from voxrt.board.loaded_scene import read_back
from voxrt.board.patch_writes import write_patch
from voxrt.board.register_writes import (
    PROBLEMS,
    camera_writes,
    decode_fields,
    encode_fields,
    lighting_writes,
    material_rows,
    register_writes,
    tell_problems,
)
from voxrt.board.registers import MATERIALS, REGISTERS
from voxrt.board.view import FEATURES
from voxrt.octree.words import EMPTY

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import NDArray

    from voxrt.board.frame_drop import FrameDrop
    from voxrt.board.loaded_scene import LoadedScene
    from voxrt.board.register_writes import Writes
    from voxrt.board.view import View
    from voxrt.octree import Patch

_MINOR = 3
_IDENTITY = int.from_bytes(b"VXRT", "big")
_STUCK_SECONDS = 30.0
_TO_RED_GREEN_BLUE = (2, 0, 1)  # the stream's bytes are green, blue, red


class Registers(Protocol):
    """The register block. Each call may be a message to the board and its answer."""

    def read(self, offsets: Sequence[int], /) -> Sequence[int]:
        """Read the registers at byte addresses, in their order."""

    def write(self, writes: Writes, /) -> None:
        """Write words from byte addresses on, in their order."""


class Memory(Protocol):
    """The words of the scene memory."""

    @property
    def base(self) -> int | None:
        """Byte address of external memory on the core's bus; None for memory on the chip."""

    def __len__(self) -> int:
        """Give the number of words."""

    def __getitem__(self, words: slice, /) -> NDArray[np.uint32]:
        """Read words."""

    def __setitem__(self, words: slice, values: NDArray[np.uint32], /) -> None:
        """Write words."""


class Video(Protocol):
    """The receiver of the AXI4-Stream video; it receives one frame at a time."""

    @property
    def size(self) -> tuple[int, int]:
        """The largest frame, columns and rows."""

    @property
    def width_step(self) -> int:
        """The width of a frame is a multiple of this number of columns."""

    def expect(self, size: tuple[int, int], /) -> None:
        """Prepare for one frame of `size`; an earlier frame that is not complete is dropped."""

    def take(self) -> NDArray[np.uint8]:
        """Wait until the frame is complete, and return it: uint8, shape (H, W, 3), the bytes of the stream.

        Raises
        ------
        DeviceError
            No frame came, or the stream was malformed.
        """

    def close(self) -> None:
        """Stop receiving."""


class RegisterDevice:
    """The driver of the registers in ``rtl/registers.rdl``; :class:`~.device.Device` documents the methods.

    Opening writes ``root``, ``depth`` and word 0 of the memory: until a scene is selected, the world is empty. Where
    the memory is external, it also writes ``memory_base``, and a frame after a write begins with empty caches.

    Parameters
    ----------
    name
        Shown to users.
    registers
        The register block.
    memory
        The scene memory.
    video
        The receiver of the frames.
    pause
        Called between two reads of the status register.
    pixel_seconds
        As :class:`~.device.Identity` has it.

    Raises
    ------
    DeviceError
        The identity register is not the ray tracer's, its version is not supported, or `memory` is not what its memory
        is.
    """

    def __init__(
        self,
        name: str,
        registers: Registers,
        memory: Memory,
        video: Video,
        pause: Callable[[], None],
        *,
        pixel_seconds: float = 2e-5,
    ) -> None:
        self._registers = registers
        self._memory = memory
        self._video = video
        self._pause = pause
        self._stopped = threading.Event()
        self._external = memory.base is not None
        self._caches_stale = False
        identity, version_word = self._read("identity", "version")
        if identity != _IDENTITY:
            raise DeviceError(f"{name}: the ray tracer does not answer; load the bitstream of voxrt")
        version = decode_fields("version", version_word)
        if version["major"] != 0:
            raise DeviceError(f"{name}: register version {version['major']} is not supported; upgrade voxrt")
        if version["minor"] < _MINOR:
            raise DeviceError(
                f"{name}: register version 0.{version['minor']} is older than 0.{_MINOR}, which has the brightness of "
                "faces; load the bitstream of this release"
            )
        names = ("configuration", "features")
        configuration, features = map(decode_fields, names, self._read(*names))
        if bool(configuration["cached"]) != self._external:
            place = "in external memory" if configuration["cached"] else "on the chip"
            raise DeviceError(
                f"{name}: the ray tracer has its octree {place}, and the block design does not; use rtl/vivado"
            )
        words = min(1 + (8 << configuration["block_bits"]), len(memory))
        self.identity = Identity(
            name=f"{name}, {configuration['lanes']} lane{'' if configuration['lanes'] == 1 else 's'}",
            version=f"{version['major']}.{version['minor']}",
            capacity=words - (words - 1) % 8,
            depth=configuration["max_depth"],
            size=video.size,
            features=frozenset(name for name in FEATURES if features[name]),
            width_step=video.width_step,
            position_limit=1 << (configuration["position_bits"] - 1),
            pixel_seconds=pixel_seconds,
        )
        # The registers and the memory may still hold the scene of an earlier program: nothing of it may be traced.
        self.hold()
        root, depth = self._read("root", "depth")
        earlier = decode_fields("root", root)["address"], decode_fields("depth", depth)["depth"], self.read_memory(0, 1)
        if memory.base is not None:
            self._write("memory_base", memory.base)
        if features["lod"]:
            self._write("lod", 0)
        self.write_memory(0, np.array([EMPTY], dtype=np.uint32))
        self.select_scene(0, 1)
        self._earlier: tuple[int, int, NDArray[np.uint32]] | None = earlier

    def loaded(self) -> LoadedScene | None:
        """Read the scene of the program before; frames do not show it. None if there is none any more.

        So a :class:`~.scene_memory.SceneMemory` can write what differs.
        """
        if self._earlier is None:
            return None
        root, depth, word_0 = self._earlier

        def read(address: int, count: int) -> NDArray[np.uint32]:
            words = self.read_memory(address, count)
            return words if address else np.append(word_0, words[1:])

        return read_back(read, self.identity.capacity, root, depth)

    def registers(self) -> Mapping[str, int]:
        """Read all registers, by name, in the order of their addresses."""
        return dict(zip(REGISTERS, self._read(*REGISTERS), strict=True))

    def hold(self) -> None:
        """Let no frame start until :meth:`frame` is called, and wait until the present one ends."""
        self._write("control", _bits("control", "hold"))
        self._wait("busy", 0, "the present frame does not end")

    def write_memory(self, address: int, words: NDArray[np.uint32]) -> None:
        """Write words from word `address` on, at once: the frame in progress, if any, goes on."""
        if self._stopped.is_set():
            raise DeviceError("the device was stopped")
        self._memory[address : address + len(words)] = words
        self._caches_stale, self._earlier = self._external, None

    def read_memory(self, address: int, count: int) -> NDArray[np.uint32]:
        """Read `count` words from word `address` on."""
        return np.array(self._memory[address : address + count], dtype=np.uint32)

    def write_materials(self, colours: NDArray[np.uint8], mirrors: NDArray[np.bool_], /) -> None:
        """Write the material table, while no frame can start."""
        self.hold()
        self._registers.write([(MATERIALS, material_rows(colours, mirrors))])

    def select_scene(self, root: int, depth: int) -> None:
        """Trace the octree at word `root` from the next frame on."""
        # The hardware latches depth and root together when a frame starts. None starts between these two writes.
        self.hold()
        self._registers.write(register_writes("depth", depth=depth) + register_writes("root", address=root))

    def apply_patch(self, patch: Patch, depth: int) -> None:
        """Write what an edit changed, and trace its root from the next frame on."""
        write_patch(self, patch, depth)

    def frame(self, view: View, seconds: float = math.inf, drop: FrameDrop | None = None) -> Frame:
        """Start a frame, wait for the frame-done bit, and return the frame."""
        started = time.perf_counter()
        columns, rows = view.size
        red, green, blue = view.background
        writes = register_writes("size", width=columns, height=rows)
        writes += camera_writes(view.camera) + lighting_writes(view.lighting)
        writes += [(MATERIALS, [red << 16 | green << 8 | blue])]
        writes += [(REGISTERS["status"][0], [_bits("status", "frame_done", *PROBLEMS)])]  # writing 1 clears
        if self._caches_stale:
            writes += register_writes("control", hold=1, flush=1)
            self._caches_stale = False
        self._video.expect(view.size)
        self._registers.write(writes + register_writes("control", start=1))
        self._wait("frame_done", 1, "the frame does not end", seconds, drop)
        status, rays, words_read, cycles = self._read("status", "rays", "words_read", "cycles")
        if problem := tell_problems(decode_fields("status", status)):
            raise DeviceError(problem)
        colour = np.ascontiguousarray(self._video.take()[..., _TO_RED_GREEN_BLUE])
        if colour.shape != (rows, columns, 3):
            raise DeviceError(
                f"the frame has {colour.shape[1]}x{colour.shape[0]} pixels instead of {columns}x{rows}; try again"
            )
        return Frame(colour, Counters(rays, words_read, cycles, time.perf_counter() - started))

    def stop(self) -> None:
        """End the frame in progress; further frames and writes to the memory fail."""
        self._stopped.set()

    def close(self) -> None:
        """Let no further frame start."""
        self.hold()
        self._video.close()

    def _wait(
        self, field: str, value: int, problem: str, seconds: float = math.inf, drop: FrameDrop | None = None
    ) -> None:
        before, end, last = -1, 0.0, time.monotonic() + seconds
        while True:
            status, pixels = self._read("status", "rays")
            if decode_fields("status", status)[field] == value:
                return
            now = time.monotonic()
            if self._stopped.is_set():
                self._drop_frame()
                raise DeviceError("the frame was stopped")
            if drop is not None and drop.requested:
                self._drop_frame()
                raise FrameDropped
            if now > last:
                self._drop_frame()
                raise TooSlow(f"the frame took more than {seconds:.1f} s")
            if pixels != before:
                before, end = pixels, now + _STUCK_SECONDS
            elif now > end:
                self._drop_frame()
                raise DeviceError(
                    f"{problem}: no pixel came for {_STUCK_SECONDS:.0f} s; the frame was dropped, try again"
                )
            self._pause()

    def _drop_frame(self) -> None:
        self._write("control", _bits("control", "soft_reset", "hold"))

    def _read(self, *names: str) -> Sequence[int]:
        return self._registers.read([REGISTERS[name][0] for name in names])

    def _write(self, name: str, value: int) -> None:
        self._registers.write([(REGISTERS[name][0], [value])])


def _bits(name: str, *fields: str) -> int:
    return encode_fields(name, **dict.fromkeys(fields, 1))
