"""``voxrt upload``."""

from __future__ import annotations

import asyncio
from pathlib import Path  # noqa: TC003 - cyclopts reads the annotations
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

import voxrt
from voxrt.cli.arguments import Reporting, choice
from voxrt.cli.board_results import UploadResult
from voxrt.cli.errors import UsageError
from voxrt.cli.lighting import supported
from voxrt.cli.messages import summarize
from voxrt.cli.progress import transfer_bar
from voxrt.cli.results import print_json
from voxrt.cli.serve import SERIAL, TCP, open_device, open_serial_device

if TYPE_CHECKING:
    from voxrt.board.device import Device
    from voxrt.board.scene import Scene
    from voxrt.board.scene_memory import LoadedScene, Progress


def upload(
    rom: Annotated[Path, Parameter(metavar="ROM")],
    /,
    *,
    to: Annotated[str | None, Parameter(metavar="URL")] = None,
    device: Annotated[Literal["model", "sim"] | None, Parameter(converter=choice)] = None,
    config: Annotated[str, Parameter(metavar="NAME")] = "lit",
    dry_run: Annotated[bool, Parameter(negative=(), show_default=False)] = False,
    reporting: Annotated[Reporting, Parameter(name="*", show_default=False)] = Reporting(),  # noqa: B008
) -> None:
    """Show another scene on a running board: its words are written, read back and compared.

    Parameters
    ----------
    rom
        A blob, or a .mem file; its manifest, the .json in the same folder, is sent with it.
    to
        The address of the page, with its token, as the frame server printed it. Or the serial line of a board, such as
        serial:/dev/ttyUSB0, or a PYNQ board that runs voxrt-board, such as tcp://pynq:4810, with its token in the
        environment variable VOXRT_BOARD_TOKEN.
    device
        A device of this machine, to try the upload without a server.
    config
        The configuration of the simulated hardware: tiny or lit.
    dry_run
        Check everything, write nothing.
    reporting
        The form of the output.
    """
    if (to is None) == (device is None):
        raise UsageError("--to and --device exclude each other; give one of them")
    if rom.suffix.lower() not in {".mem", ".blob"}:
        raise UsageError(f"{rom}: is no .mem or .blob; build it first: voxrt build {rom}")
    scene = _read(rom)
    with transfer_bar() as progress:
        if to is not None and to.startswith(SERIAL):
            _write_serial(rom, scene, to.removeprefix(SERIAL), progress, dry_run=dry_run)
        elif to is not None and not to.startswith(TCP):
            asyncio.run(_send(rom, scene, to, progress, dry_run=dry_run))
        else:
            opened = open_device(to or device or "model", config)
            try:
                _write(scene, opened, progress, dry_run=dry_run)
            finally:
                opened.close()
    done = "checked; nothing was written" if dry_run else "loaded"
    if reporting.json:
        print_json(UploadResult(scene.name, scene.depth, len(scene.words), scene.crc32, written=not dry_run))
    else:
        summarize(f"{rom.name}: {done}", [("words", str(len(scene.words))), ("crc-32", f"{scene.crc32:08X}")])


def _read(path: Path) -> Scene:
    from voxrt.boards.board_scenes import load_scene  # noqa: PLC0415 - it imports NumPy

    try:
        return load_scene(path)
    except OSError as error:
        raise voxrt.RomError(f"{path}: {error}") from error


async def _send(path: Path, scene: Scene, url: str, progress: Progress, *, dry_run: bool) -> None:
    from voxrt.board.errors import Refused  # noqa: PLC0415
    from voxrt.serve.frame_client import open_client  # noqa: PLC0415 - it imports websockets

    try:
        manifest = [path.with_suffix(".json")] if path.suffix.lower() == ".mem" else []
        files = {file.name: file.read_bytes() for file in (path, *manifest) if file.exists()}
    except OSError as error:
        raise voxrt.RomError(f"{path}: {error}") from error
    try:
        async with open_client(url) as client:
            _check_fit(scene, client.hello["device"])
            await client.take_control()
            await client.upload(files, progress, check_only=dry_run)
    except Refused as refusal:
        raise voxrt.SimulatorError(str(refusal)) from refusal


def _check_fit(scene: Scene, board: dict[str, Any]) -> None:
    words = len(scene.words)
    if words > board["capacity"] or scene.depth > board["depth"]:
        raise voxrt.DoesNotFitError(
            f"{scene.name} has {words} words and {scene.depth} levels, and {board['name']} takes {board['capacity']} "
            f"and {board['depth']}; build it with a smaller --depth"
        )


def _write_serial(path: Path, scene: Scene, port: str, progress: Progress, *, dry_run: bool) -> None:
    """Let the board at a serial line show the scene and turn, as from its bitstream."""
    from voxrt.board.errors import DeviceError  # noqa: PLC0415
    from voxrt.boards.beam import SCREEN, BoardTracer, fit_beam  # noqa: PLC0415
    from voxrt.views.orbit import orbit  # noqa: PLC0415

    rom = voxrt.read_any(path)[0].rom
    try:
        device = open_serial_device(port)
        try:
            _write(scene, device, progress, dry_run=True)
            if not dry_run:
                lighting = supported(scene.lighting or voxrt.Lighting(), device.identity.features)
                size, scale = SCREEN, 0
                if not device.frame_buffer:
                    tracer = BoardTracer(device.lanes, device.ray_clocks, device.clock_hz, device.buffer_lines)
                    beam = fit_beam(
                        rom,
                        orbit(rom, SCREEN),
                        lighting,
                        tracer,
                        progress=lambda done, total: progress("count cycles", done, total),
                    )
                    size, scale = beam.size, beam.scale
                device.prepare_orbit(orbit(rom, size), lighting, scale)
                _write(scene, device, progress, dry_run=False, loaded=device.loaded())
        finally:
            device.close()
    except DeviceError as error:
        raise voxrt.SimulatorError(str(error)) from error


def _write(
    scene: Scene, device: Device, progress: Progress, *, dry_run: bool, loaded: LoadedScene | None = None
) -> None:
    from voxrt.board.errors import DeviceError, Refused  # noqa: PLC0415 - only this command needs them
    from voxrt.board.scene_memory import SceneMemory  # noqa: PLC0415

    memory = SceneMemory(device, loaded)
    try:
        if dry_run:
            memory.check(scene)
        else:
            memory.load(scene, progress)
    except Refused as refusal:
        raise voxrt.DoesNotFitError(str(refusal)) from refusal
    except DeviceError as error:
        raise voxrt.SimulatorError(str(error)) from error
