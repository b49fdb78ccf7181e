"""An ECP5 board at a serial line as a :class:`~.device.Device`: its monitor shows what the page shows.

The board sends no pictures. Frames for the page come from a second device, the exact model, which holds the same scene
and renders the same camera.
"""

from __future__ import annotations

import math
import threading
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from voxrt.board.designs.boot_table import (
    BOARD_REGISTERS,
    CAMERA_WORDS,
    CAMERAS,
    CAMERAS_WORD,
    OCTREE_MEMORY,
    PAGE_WORDS,
    RUN,
    SCREEN,
    SDRAM_REGISTERS,
    STEERED,
    TABLE,
    TURN,
    encode_list,
)
from voxrt.board.device import Counters, Frame, Identity
from voxrt.board.errors import DeviceError
from voxrt.board.loaded_scene import read_back
from voxrt.board.patch_writes import block_writes, write_blocks
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
from voxrt.board.view import FEATURES, refit

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from numpy.typing import ArrayLike, NDArray

    from voxrt.board.designs.serial_link import SerialLink
    from voxrt.board.device import Device
    from voxrt.board.frame_drop import FrameDrop
    from voxrt.board.loaded_scene import LoadedScene
    from voxrt.board.register_writes import Writes
    from voxrt.board.view import Camera, Lighting, View
    from voxrt.octree import Patch

_BOARD = int.from_bytes(b"VXBD", "big")
_CORE = int.from_bytes(b"VXRT", "big")
_MAJOR = 1
_FRAME_CRC_MINOR = 1
"""The first minor version with the register `frame_crc`."""
_WAIT_SECONDS = 5.0
_LARGEST_SCALE = 2
_SCALE_BITS = 0x30
_PERIOD_BITS = 0xFF00
_SCENE_WORD = 0
"""Where the list of the present scene is in the table: that of power-on, or the last one that changed the scene."""
_FREE_WORDS = (1024, 1536)
"""Parts of the table where other lists of the host are written, in turn."""
_LIST_WORDS = 512
"""Words of such a part."""


class SerialDevice:
    """The driver of the board designs; :class:`~.device.Device` documents the methods.

    Opening changes nothing: the board goes on showing its scene. The first frame or the first scene makes it follow
    this host. A list of writes takes effect between two frames of the board, so it shows the old scene or the new one.

    Parameters
    ----------
    link
        The serial line.
    model
        The device that renders the frames for the page.

    Raises
    ------
    DeviceError
        The board does not answer, or its design is not supported.

    Attributes
    ----------
    lanes
        Of the ray tracer.
    clock_hz
        Of the ray tracer.
    buffer_lines
        Lines of a picture that the board's line buffer holds.
    frame_buffer
        The board holds whole frames: pictures have the screen's size, however long they take.
    """

    def __init__(self, link: SerialLink, model: Device) -> None:
        self._link = link
        self._model = model
        self._materials: tuple[NDArray[np.uint8], NDArray[np.bool_]] | None = None
        self._orbit: tuple[NDArray[np.uint32], Writes] | None = None
        self._next_list = 0
        self._stopped = threading.Event()
        if self._board("identity") != _BOARD or self._core("identity")["value"] != _CORE:
            raise DeviceError(f"{link.name}: this is no board of voxrt; load a bitstream of voxrt bitstream")
        version = self._board("version")
        self._has_frame_crc = version & 0xFF >= _FRAME_CRC_MINOR
        if version >> 8 & 0xFF != _MAJOR:
            raise DeviceError(f"{link.name}: design version {version >> 8} is not supported; load a new bitstream")
        configuration = self._core("configuration")
        self.lanes = lanes = configuration["lanes"]
        self.ray_clocks = configuration["ray_clocks"] or 8
        self.clock_hz = self._board("clock")
        self.buffer_lines = 16 << (version >> 16 & 3)
        self.frame_buffer = bool(configuration["cached"])
        blocks = 1 << configuration["block_bits"]
        if self.frame_buffer:
            blocks = int(link.read(SDRAM_REGISTERS["blocks"], 1)[0])
            link.write(SDRAM_REGISTERS["page"], [0])  # a host that was killed left another one
        self.identity = Identity(
            name=f"board at {link.name}, {lanes} lane{'' if lanes == 1 else 's'}",
            version=f"{version >> 8 & 0xFF}.{version & 0xFF}",
            capacity=1 + 8 * blocks,
            depth=configuration["max_depth"],
            size=SCREEN,
            position_limit=1 << (configuration["position_bits"] - 1),
            features=frozenset(name for name in FEATURES if self._core("features")[name]),
            clock=self.clock_hz,
        )
        self._repeated = self._board("underruns"), self._board("late")

    def loaded(self) -> LoadedScene | None:
        """Read the scene that the board shows, and where it is; None if its words are no octree."""
        rows = _material_rows(self._link.read(TABLE + 4 * _SCENE_WORD, CAMERAS_WORD))
        colours = np.stack([rows >> 16 & 0xFF, rows >> 8 & 0xFF, rows & 0xFF], axis=1).astype(np.uint8)
        mirrors = (rows >> 24 & 1).astype(np.bool_)
        root, depth = self._core("root")["address"], self._core("depth")["depth"]
        found = read_back(self.read_memory, self.identity.capacity, root, depth)
        if found is None:
            return None
        return replace(found, scene=replace(found.scene, colours=colours, mirrors=mirrors), shown=True)

    def registers(self) -> Mapping[str, int]:
        """Read all registers, by name: the ray tracer's, then the board's."""
        core = {name: int(self._link.read(address, 1)[0]) for name, (address, _) in REGISTERS.items()}
        names = [name for name in BOARD_REGISTERS if name != "frame_crc" or self._has_frame_crc]
        return {**core, **{f"board.{name}": self._board(name) for name in names}}

    def hold(self) -> None:
        """Let no frame start until :meth:`frame` is called, and wait until the present one ends."""
        self._write_board("control", self._board("control") & ~RUN | STEERED)
        self._wait_until(lambda: not self._core("status")["busy"], "the present frame does not end")
        # The line buffer takes the last words of the frame by the next blanking, in which a list is played.
        self._play_next([])

    def write_memory(self, address: int, words: NDArray[np.uint32]) -> None:
        """Write words from word `address` on, at once: the frame in progress, if any, goes on."""
        for page, word, part in _pages(address, len(words)):
            with self._page(page):
                self._link.write(OCTREE_MEMORY + 4 * word, words[part])
        self._model.write_memory(address, words)

    def read_memory(self, address: int, count: int) -> NDArray[np.uint32]:
        """Read `count` words from word `address` on. The model has them then, too."""
        words = np.zeros(count, dtype=np.uint32)
        for page, word, part in _pages(address, count):
            with self._page(page):
                words[part] = self._link.read(OCTREE_MEMORY + 4 * word, part.stop - part.start)
        self._model.write_memory(address, words)
        return words

    def write_materials(self, colours: NDArray[np.uint8], mirrors: NDArray[np.bool_], /) -> None:
        """Keep the material table; :meth:`select_scene` writes it together with the scene."""
        self._materials = colours.copy(), mirrors.copy()

    def prepare_orbit(self, cameras: Sequence[Camera], lighting: Lighting, scale: int, period: int = 3) -> None:
        """Make :meth:`select_scene` replace the orbit as well, and let the board turn by itself afterwards.

        Parameters
        ----------
        cameras
            128 of them, for pictures of 640 x 480 pixels divided by 2**scale.
        lighting
            Of the pictures.
        scale
            0 ... 2.
        period
            Frames per camera.
        """
        if len(cameras) != CAMERAS:
            raise ValueError(f"an orbit has {CAMERAS} cameras, not {len(cameras)}")
        lists = [encode_list(camera_writes(camera), end=False) for camera in cameras]
        width, height = (side >> scale for side in SCREEN)
        control = period << 8 | scale << 4 | RUN | TURN
        writes = register_writes("size", width=width, height=height) + lighting_writes(lighting)
        writes += [(BOARD_REGISTERS["camera"], [0]), (BOARD_REGISTERS["control"], [control])]
        self._orbit = np.array(lists, dtype=np.uint32).ravel(), writes

    def select_scene(self, root: int, depth: int) -> None:
        """Show the octree at word `root` from the next frame on, with the materials that were written last."""
        writes = self._scene_writes(root, depth)
        orbit, self._orbit = self._orbit, None
        if orbit is None:
            self._play(writes, _SCENE_WORD)
        else:
            self._replace_orbit(writes + orbit[1], orbit[0])
        self._hand_on_materials()
        self._model.select_scene(root, depth)

    def apply_patch(self, patch: Patch, depth: int) -> None:
        """Write what an edit changed by one list, between two frames; blocks without room in it are written before.

        The word of the root is always in the list: the memory knows then that its caches hold an older one.
        """
        last = list(_paged_writes(patch.root, np.array([patch.root_word], np.uint32)))
        writes = [write for address, words in block_writes(patch) for write in _paged_writes(address, words)]
        final = last + self._scene_writes(patch.root, depth)
        if len(encode_list(writes + final)) <= _LIST_WORDS:
            final = writes + final
            for address, words in block_writes(patch):
                self._model.write_memory(address, words)
        else:
            write_blocks(self, patch)
        self._play_next(final)
        self._hand_on_materials()
        self._model.write_memory(patch.root, np.array([patch.root_word], np.uint32))
        self._model.select_scene(patch.root, depth)

    def frame(self, view: View, seconds: float = math.inf, drop: FrameDrop | None = None) -> Frame:
        """Render a view by the model, and show it on the monitor; the model's picture is returned."""
        started = time.perf_counter()
        picture = self._model.frame(view, seconds, drop)
        control = self._board("control")
        scale = self._choose_scale(control >> 4 & 3)
        size = SCREEN[0] >> scale, SCREEN[1] >> scale
        red, green, blue = view.background
        writes = register_writes("size", width=size[0], height=size[1])
        writes += camera_writes(refit(view.camera, view.size, size)) + lighting_writes(view.lighting)
        writes += [(MATERIALS, [red << 16 | green << 8 | blue])]
        writes += [(BOARD_REGISTERS["control"], [control & _PERIOD_BITS | scale << 4 | STEERED | RUN])]
        self._play_next(writes)
        problem = tell_problems(self._core("status"))
        if problem:
            clear = encode_fields("status", **dict.fromkeys(PROBLEMS, 1))  # writing 1 clears
            self._link.write(REGISTERS["status"][0], [clear])
            raise DeviceError(problem)
        counters = Counters(picture.counters.rays, None, None, time.perf_counter() - started)
        return replace(picture, counters=counters)

    def show_again(self) -> None:
        """Let the board show its scene by itself, as it did before the first frame."""
        self._write_board("play", _SCENE_WORD)
        self._wait_until(lambda: not self._board("play") >> 31, "the board does not start a frame")

    def stop(self) -> None:
        """End what is in progress; further frames and writes fail."""
        self._stopped.set()
        self._model.stop()

    def close(self) -> None:
        """Close the line; the board goes on showing the last frame."""
        self._link.close()

    def _choose_scale(self, present: int) -> int:
        """Take pixels of twice the side when the board could not keep up with the screen since the last frame."""
        if self.frame_buffer:
            return 0
        repeated = self._board("underruns"), self._board("late")
        behind, self._repeated = repeated != self._repeated, repeated
        return min(present + behind, _LARGEST_SCALE)

    @contextmanager
    def _page(self, page: int) -> Iterator[None]:
        """Let the address map show a page of the octree; other hosts find the first one."""
        if page:
            self._link.write(SDRAM_REGISTERS["page"], [page])
        yield
        if page:
            self._link.write(SDRAM_REGISTERS["page"], [0])

    def _replace_orbit(self, writes: Writes, cameras: NDArray[np.uint32]) -> None:
        """Write the cameras while none of them is played, then play `writes`. A failure leaves the old cameras."""
        place = TABLE + 4 * CAMERAS_WORD
        control = self._board("control")
        before = self._link.read(place, CAMERAS * CAMERA_WORDS)
        self._write_board("control", control | STEERED)
        try:
            if not np.array_equal(before, cameras):
                self._write_checked(place, cameras)
            self._play(writes, _SCENE_WORD)
        except DeviceError:
            self._write_checked(place, before)
            self._write_board("control", control)
            raise

    def _scene_writes(self, root: int, depth: int) -> Writes:
        """Give the writes that select an octree, with the materials that were written last and not shown yet."""
        writes = register_writes("depth", depth=depth) + register_writes("root", address=root)
        return writes if self._materials is None else [*writes, (MATERIALS, material_rows(*self._materials))]

    def _hand_on_materials(self) -> None:
        """Give the model the materials that the board has now."""
        if self._materials is not None:
            self._model.write_materials(*self._materials)
        self._materials = None

    def _play_next(self, writes: Writes) -> None:
        """Play writes from a part of the table that the last ones are not in."""
        self._play(writes, _FREE_WORDS[self._next_list])
        self._next_list = (self._next_list + 1) % len(_FREE_WORDS)

    def _play(self, writes: Writes, word: int) -> None:
        """Let the board carry out writes, as a list at a word of the table, between two frames; wait until it has."""
        self._write_checked(TABLE + 4 * word, encode_list(writes))
        self._write_board("play", word)
        self._wait_until(lambda: not self._board("play") >> 31, "the board does not start a frame")

    def _write_checked(self, address: int, words: ArrayLike) -> None:
        expected = np.asarray(words, dtype=np.uint32)
        self._link.write(address, expected)
        if not np.array_equal(self._link.read(address, len(expected)), expected):
            raise DeviceError(
                f"{self._link.name}: the table at 0x{address:06X} does not keep what was written; try again, "
                "and load the bitstream again if that repeats"
            )

    def _wait_until(self, reached: Callable[[], bool], problem: str) -> None:
        end = time.monotonic() + _WAIT_SECONDS
        while not reached():
            if self._stopped.is_set():
                raise DeviceError("the frame was stopped")
            if time.monotonic() > end:
                raise DeviceError(
                    f"{self._link.name}: {problem} within {_WAIT_SECONDS:.0f} s; load the bitstream again"
                )

    def _board(self, name: str) -> int:
        return int(self._link.read(BOARD_REGISTERS[name], 1)[0])

    def _write_board(self, name: str, value: int) -> None:
        self._link.write(BOARD_REGISTERS[name], [value])

    def _core(self, name: str) -> dict[str, int]:
        return decode_fields(name, int(self._link.read(REGISTERS[name][0], 1)[0]))


def _pages(address: int, count: int) -> Iterator[tuple[int, int, slice]]:
    """Cut words of the octree at pages: the page, the first word in it, and which of the words these are."""
    start = 0
    while start < count:
        page, word = divmod(address + start, PAGE_WORDS)
        stop = min(count, start + PAGE_WORDS - word)
        yield page, word, slice(start, stop)
        start = stop


def _paged_writes(address: int, words: NDArray[np.uint32]) -> Iterator[tuple[int, list[int]]]:
    """Give the writes of a list that writes words of the octree. It leaves the first page in the address map."""
    for page, word, part in _pages(address, len(words)):
        if page:
            yield SDRAM_REGISTERS["page"], [page]
        yield OCTREE_MEMORY + 4 * word, words[part].tolist()
        if page:
            yield SDRAM_REGISTERS["page"], [0]


def _material_rows(table: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """Find what the list at the table's first word writes to the material table: uint32, shape (256,)."""
    rows = np.zeros(256, dtype=np.uint32)
    word = 0
    while word < len(table) and (count := int(table[word]) >> 24):
        first = ((int(table[word]) & 0xFFFFFF) - MATERIALS) // 4
        data = table[word + 1 : word + 1 + count]
        if 0 <= first < len(rows):
            rows[first : first + count] = data[: len(rows) - first]
        word += 1 + count
    return rows
