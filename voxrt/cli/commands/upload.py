"""``voxrt upload``."""

from __future__ import annotations

import asyncio
import sys
from contextlib import closing
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

import voxrt
from voxrt.cli.commands.serve import SERIAL, TCP, board_errors, open_device, open_serial_device, read_scene, scene_files
from voxrt.cli.inputs.lighting import supported
from voxrt.cli.results.board_results import UploadResult
from voxrt.cli.results.build_results import print_json
from voxrt.cli.terminal.errors import UsageError
from voxrt.cli.terminal.messages import complain, summarize
from voxrt.cli.terminal.progress import transfer_bar

if TYPE_CHECKING:
    from voxrt.board.designs.serial_device import SerialDevice
    from voxrt.board.device import Device
    from voxrt.board.scene import Scene
    from voxrt.board.scene_memory import Progress, SceneMemory
    from voxrt.options.board_commands import UploadCommand

_STANDARD_INPUT = Path("-")


def run(options: UploadCommand) -> None:
    """Show another scene on a running board: its words are written, read back and compared."""
    if options.to is None and options.device is None:
        raise UsageError("neither --to nor --device says where the board is; give one of them")
    if options.to is not None and options.device is not None:
        raise UsageError("--to and --device exclude each other; give one of them")
    with closing(_Receiver(options)) as receiver:
        if options.rom != _STANDARD_INPUT:
            receiver.show(options.rom)
            return
        failed = count = 0
        for count, line in enumerate(sys.stdin, 1):  # noqa: B007 - the last one is the number of lines
            try:
                receiver.show(Path(line.rstrip("\n")))
            except (voxrt.RomError, voxrt.DoesNotFitError, voxrt.SimulatorError, UsageError) as error:
                complain(str(error))
                failed += 1
        if failed:
            raise voxrt.SimulatorError(f"{failed} of {count} memories were not shown")


class _Receiver:
    """What shows scenes: a server, or a device that stays open from one scene to the next."""

    def __init__(self, options: UploadCommand) -> None:
        self._options = options
        self._address = options.to or options.device or ""
        self._board: SerialDevice | None = None
        self._device: Device | None = None
        self._memory: SceneMemory | None = None

    def show(self, path: Path) -> None:
        """Show the scene of a file."""
        from voxrt.board.scene import MEMORY_SUFFIXES  # noqa: PLC0415 - it imports NumPy

        if path.suffix.lower() not in MEMORY_SUFFIXES:
            raise UsageError(f"{path}: is no .mem or .blob; build it first: voxrt build {path}")
        scene, dry_run = read_scene(path), self._options.dry_run
        with transfer_bar() as progress:
            if self._options.device is None and not self._address.startswith((SERIAL, TCP)):
                asyncio.run(_send(path, scene, self._address, progress, dry_run=dry_run))
            else:
                with board_errors():
                    self._load(path, scene, progress)
        done = "checked; nothing was written" if dry_run else "loaded"
        if self._options.reporting.json:
            print_json(UploadResult(scene.name, scene.depth, len(scene.words), scene.crc32, written=not dry_run))
        else:
            summarize(f"{path.name}: {done}", [("words", str(len(scene.words))), ("crc-32", f"{scene.crc32:08X}")])

    def close(self) -> None:
        """Close the line of the board."""
        if self._device is not None:
            self._device.close()
        self._board = self._device = self._memory = None

    def _load(self, path: Path, scene: Scene, progress: Progress) -> None:
        from voxrt.board.errors import DeviceError  # noqa: PLC0415 - as above

        memory = self._memory or self._open()
        try:
            memory.check(scene)
            if self._options.dry_run:
                return
            if self._board is not None:
                _prepare_orbit(self._board, path, scene, progress)
            memory.load(scene, progress)
        except DeviceError:
            self.close()  # the next scene opens it again, and reads what it has
            raise

    def _open(self) -> SceneMemory:
        from voxrt.board.scene_memory import SceneMemory  # noqa: PLC0415 - as above

        if self._address.startswith(SERIAL):
            self._device = self._board = open_serial_device(self._address.removeprefix(SERIAL))
        else:
            self._device = open_device(self._address, self._options.config)
        self._memory = SceneMemory(self._device, None if self._options.dry_run else self._device.loaded())
        return self._memory


async def _send(path: Path, scene: Scene, url: str, progress: Progress, *, dry_run: bool) -> None:
    from voxrt.board.errors import Refused  # noqa: PLC0415
    from voxrt.board.scene import check_size  # noqa: PLC0415
    from voxrt.serve.frame_client import open_client  # noqa: PLC0415 - it imports websockets

    try:
        files = {file.name: file.read_bytes() for file in scene_files(path)}
    except OSError as error:
        raise voxrt.RomError(f"{path}: {error}") from error
    try:
        async with open_client(url) as client:
            with board_errors():
                check_size(scene, *(client.hello["device"][key] for key in ("name", "capacity", "depth")))
            await client.take_control()
            await client.upload(files, progress, check_only=dry_run)
    except Refused as refusal:
        raise voxrt.SimulatorError(str(refusal)) from refusal


def _prepare_orbit(board: SerialDevice, path: Path, scene: Scene, progress: Progress) -> None:
    """Let the board at a serial line turn the next scene, as from its bitstream."""
    from voxrt.boards.beam import SCREEN, BoardTracer, fit_beam  # noqa: PLC0415
    from voxrt.views.viewpoint import orbit  # noqa: PLC0415

    rom = voxrt.read_any(path)[0].rom
    lighting = supported(scene.lighting or voxrt.Lighting(), board.identity.features)
    size, scale = SCREEN, 0
    if not board.frame_buffer:
        tracer = BoardTracer(board.lanes, board.ray_clocks, board.clock_hz, board.buffer_lines)
        beam = fit_beam(rom, orbit(rom, SCREEN), lighting, tracer, progress=partial(progress, "count cycles"))
        size, scale = beam.size, beam.scale
    board.prepare_orbit(orbit(rom, size), lighting, scale)
