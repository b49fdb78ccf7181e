"""``voxrt upload``."""

from __future__ import annotations

import asyncio
from contextlib import closing
from functools import partial
from typing import TYPE_CHECKING

import voxrt
from voxrt.cli.commands.serve import SERIAL, TCP, board_errors, open_device, open_serial_device, read_scene, scene_files
from voxrt.cli.inputs.lighting import supported
from voxrt.cli.results.board_results import UploadResult
from voxrt.cli.results.build_results import print_json
from voxrt.cli.terminal.errors import UsageError
from voxrt.cli.terminal.messages import summarize
from voxrt.cli.terminal.progress import transfer_bar

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.board.device import Device
    from voxrt.board.scene import Scene
    from voxrt.board.scene_memory import Progress
    from voxrt.options.board_commands import UploadCommand


def run(options: UploadCommand) -> None:
    """Show another scene on a running board: its words are written, read back and compared."""
    from voxrt.board.scene import MEMORY_SUFFIXES  # noqa: PLC0415 - it imports NumPy

    if options.to is None and options.device is None:
        raise UsageError("neither --to nor --device says where the board is; give one of them")
    if options.to is not None and options.device is not None:
        raise UsageError("--to and --device exclude each other; give one of them")
    if options.rom.suffix.lower() not in MEMORY_SUFFIXES:
        raise UsageError(f"{options.rom}: is no .mem or .blob; build it first: voxrt build {options.rom}")
    scene = read_scene(options.rom)
    with transfer_bar() as progress:
        if options.to is not None and options.to.startswith(SERIAL):
            _write_serial(options.rom, scene, options.to.removeprefix(SERIAL), progress, dry_run=options.dry_run)
        elif options.to is not None and not options.to.startswith(TCP):
            asyncio.run(_send(options.rom, scene, options.to, progress, dry_run=options.dry_run))
        else:
            with closing(open_device(options.to or options.device or "model", options.config)) as opened:
                _write(scene, opened, progress, dry_run=options.dry_run)
    done = "checked; nothing was written" if options.dry_run else "loaded"
    if options.reporting.json:
        print_json(UploadResult(scene.name, scene.depth, len(scene.words), scene.crc32, written=not options.dry_run))
    else:
        summarize(f"{options.rom.name}: {done}", [("words", str(len(scene.words))), ("crc-32", f"{scene.crc32:08X}")])


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


def _write_serial(path: Path, scene: Scene, port: str, progress: Progress, *, dry_run: bool) -> None:
    """Let the board at a serial line show the scene and turn, as from its bitstream."""
    from voxrt.boards.beam import SCREEN, BoardTracer, fit_beam  # noqa: PLC0415
    from voxrt.views.viewpoint import orbit  # noqa: PLC0415

    rom = voxrt.read_any(path)[0].rom
    with board_errors(), closing(open_serial_device(port)) as device:
        _write(scene, device, progress, dry_run=True)
        if dry_run:
            return
        lighting = supported(scene.lighting or voxrt.Lighting(), device.identity.features)
        size, scale = SCREEN, 0
        if not device.frame_buffer:
            tracer = BoardTracer(device.lanes, device.ray_clocks, device.clock_hz, device.buffer_lines)
            count = partial(progress, "count cycles")
            beam = fit_beam(rom, orbit(rom, SCREEN), lighting, tracer, progress=count)
            size, scale = beam.size, beam.scale
        device.prepare_orbit(orbit(rom, size), lighting, scale)
        _write(scene, device, progress, dry_run=False)


def _write(scene: Scene, device: Device, progress: Progress, *, dry_run: bool) -> None:
    from voxrt.board.scene_memory import SceneMemory  # noqa: PLC0415 - only this command needs it

    with board_errors():
        if dry_run:
            SceneMemory(device).check(scene)
        else:
            SceneMemory(device, device.loaded()).load(scene, progress)
