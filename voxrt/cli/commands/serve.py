"""``voxrt serve``."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
from pathlib import Path
from typing import TYPE_CHECKING

import voxrt
from voxrt.cli.results.board_results import ServeResult
from voxrt.cli.results.build_results import print_json
from voxrt.cli.terminal.errors import UsageError
from voxrt.cli.terminal.messages import summarize

if TYPE_CHECKING:
    from collections.abc import Iterator

    from voxrt.board.designs.serial_device import SerialDevice
    from voxrt.board.device import Device
    from voxrt.board.scene import Scene
    from voxrt.options.board_commands import ServeCommand
    from voxrt.serve.scene_library import SceneLibrary
    from voxrt.serve.server import FrameServer
    from voxrt.serve.server_options import ServerOptions

SERIAL, TCP = "serial:", "tcp://"


def run(options: ServeCommand) -> None:
    """Show scenes live in the browser until Ctrl-C."""
    from voxrt.board.errors import Refused  # noqa: PLC0415
    from voxrt.boards.board_scenes import asset_reader  # noqa: PLC0415 - it imports NumPy
    from voxrt.serve.freed_memory import return_freed_memory  # noqa: PLC0415
    from voxrt.serve.scene_library import SceneLibrary, scene_names  # noqa: PLC0415
    from voxrt.serve.server_options import ServerOptions  # noqa: PLC0415
    from voxrt.serve.token import choose_token  # noqa: PLC0415

    try:
        token = choose_token(options.host, options.token, options.token_file)
    except Refused as refusal:
        raise UsageError(str(refusal)) from refusal
    return_freed_memory()
    first = read_scene(options.scenes[0], options.depth) if options.scenes else None
    named = {name: scene_files(path) for name, path in scene_names(options.scenes or _examples()).items()}
    library = SceneLibrary(asset_reader(options.depth), named, asset_reader(options.depth, memory_depth=options.depth))
    server = ServerOptions(options.host, options.port, token, options.origin, options.legacy_port)
    opened = open_device(options.device, options.config)
    with board_errors(), contextlib.suppress(asyncio.CancelledError):
        asyncio.run(_serve(opened, first, library, server, json=options.reporting.json))


def _examples() -> list[Path]:
    """Return the example scenes that are installed with voxrt; in a checkout they are links."""
    from voxrt.boards.board_scenes import ASSET_READER_SUFFIXES  # noqa: PLC0415 - it imports NumPy

    folder = Path(voxrt.__file__).with_name("example_scenes")
    return sorted(path.resolve() for path in folder.iterdir() if path.suffix in ASSET_READER_SUFFIXES)


@contextlib.contextmanager
def board_errors() -> Iterator[None]:
    """Raise what a board says of its scene as a DoesNotFitError, and of itself as a SimulatorError."""
    from voxrt.board.errors import DeviceError, Refused  # noqa: PLC0415 - most commands do without

    try:
        yield
    except Refused as refusal:
        raise voxrt.DoesNotFitError(str(refusal)) from refusal
    except DeviceError as error:
        raise voxrt.SimulatorError(str(error)) from error


def open_device(name: str, config: str) -> Device:
    """Open a device: ``model``, ``sim``, ``serial:PORT`` or ``tcp://BOARD:PORT``."""
    from voxrt.board.simulated.core import open_rtl  # noqa: PLC0415 - it imports NumPy
    from voxrt.board.simulated.model import ModelDevice  # noqa: PLC0415
    from voxrt.board.tcp_device import TOKEN_VARIABLE, open_tcp  # noqa: PLC0415

    if name.lower() == "model":
        return ModelDevice()
    if name.lower() == "sim":
        return open_rtl(config)
    with board_errors():
        if name.startswith(SERIAL):
            return open_serial_device(name.removeprefix(SERIAL))
        if name.startswith(TCP):
            return open_tcp(name, os.environ.get(TOKEN_VARIABLE, ""))
    raise UsageError(f"--device {name} is no device; there are model, sim, serial:PORT and tcp://BOARD:PORT")


def open_serial_device(port: str) -> SerialDevice:
    """Open the board at a serial line; DeviceError if there is no port of this name, or no board of voxrt at it."""
    from voxrt.board.designs.serial_device import SerialDevice  # noqa: PLC0415
    from voxrt.board.designs.serial_link import open_serial  # noqa: PLC0415
    from voxrt.board.simulated.model import ModelDevice  # noqa: PLC0415

    return SerialDevice(open_serial(port), ModelDevice())


def read_scene(path: Path, depth: int | None = None) -> Scene:
    """Read the scene of a file, as a board takes it; RomError if the file cannot be read."""
    from voxrt.boards.board_scenes import load_scene  # noqa: PLC0415 - it imports NumPy

    try:
        return load_scene(path, depth)
    except OSError as error:
        raise voxrt.RomError(f"{path}: {error}") from error


def scene_files(path: Path) -> list[Path]:
    """Return the file of a scene, and the manifest of a memory where it has one."""
    manifest = path.with_suffix(".json")
    return [path, manifest] if path.suffix.lower() == ".mem" and manifest.exists() else [path]


async def _loaded(server: FrameServer, scene: Scene, interrupted: asyncio.Event) -> bool:
    """Load the first scene; False where that was interrupted."""
    loading = asyncio.ensure_future(server.session.renderer.load(scene, lambda _stage, _done, _total: None))
    ending = asyncio.ensure_future(interrupted.wait())
    done, _ = await asyncio.wait((loading, ending), return_when=asyncio.FIRST_COMPLETED)
    ending.cancel()
    if loading in done:
        await loading
        return True
    loading.cancel()
    return False


async def _serve(
    device: Device, first: Scene | None, library: SceneLibrary, options: ServerOptions, *, json: bool
) -> None:
    from voxrt.serve.server import FrameServer  # noqa: PLC0415

    interrupted = asyncio.Event()
    loop = asyncio.get_running_loop()
    try:
        for number in (signal.SIGINT, signal.SIGTERM):
            loop.add_signal_handler(number, interrupted.set)
        async with FrameServer(device, library, options) as server:
            if first is not None and not await _loaded(server, first, interrupted):
                return
            if json:
                print_json(ServeResult(server.url, server.urls, server.port, server.legacy_port))
            summarize(
                f"serving {first.name if first else 'no scene'} on {device.identity.name}; Ctrl-C ends it:",
                [("page", url) for url in server.urls]
                + ([("legacy", f"port {server.legacy_port}")] if server.legacy_port is not None else []),
            )
            await interrupted.wait()
    except OSError as error:
        raise UsageError(
            f"cannot listen on {options.host} port {options.port}: {error.strerror or error}; choose another --port"
        ) from error
