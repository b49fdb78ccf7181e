"""``voxrt serve``."""

from __future__ import annotations

import asyncio
import contextlib
import gc
import os
import signal
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

import voxrt
from voxrt.cli.arguments import Reporting, whole
from voxrt.cli.board_results import ServeResult
from voxrt.cli.errors import UsageError
from voxrt.cli.messages import summarize
from voxrt.cli.results import print_json
from voxrt.cli.start import USUAL_GARBAGE

if TYPE_CHECKING:
    from voxrt.board.designs.serial_device import SerialDevice
    from voxrt.board.device import Device
    from voxrt.board.scene import Scene
    from voxrt.serve.scene_library import SceneLibrary
    from voxrt.serve.server import FrameServer
    from voxrt.serve.server_options import ServerOptions

SERIAL, TCP = "serial:", "tcp://"
_port = Parameter(converter=whole, metavar="PORT")


def serve(
    *scenes: Annotated[Path, Parameter(metavar="SCENE")],
    device: Annotated[str, Parameter(metavar="model|sim|serial:PORT|tcp://BOARD:PORT")] = "model",
    config: Annotated[str, Parameter(metavar="NAME")] = "lit",
    host: Annotated[str, Parameter(metavar="ADDRESS")] = "127.0.0.1",
    port: Annotated[int, _port] = 8080,
    token: Annotated[str | None, Parameter(metavar="TEXT")] = None,
    token_file: Annotated[Path | None, Parameter(metavar="FILE")] = None,
    origin: Annotated[tuple[str, ...], Parameter(metavar="ORIGIN")] = (),
    legacy_port: Annotated[int | None, _port] = None,
    depth: Annotated[int | None, Parameter(converter=whole, metavar="N")] = None,
    reporting: Annotated[Reporting, Parameter(name="*", show_default=False)] = Reporting(),  # noqa: B008
) -> None:
    """Show scenes live in the browser until Ctrl-C.

    Parameters
    ----------
    scenes
        Blobs, memories (.mem) and assets. The first is shown at once; the page lists all. Without scenes, the page
        lists examples and has a place to drop files.
    device
        The renderer: the exact model, the simulated hardware, which is slow, a board at a serial line, such as
        serial:/dev/ttyUSB0, whose monitor follows the page, or a PYNQ board that runs voxrt-board, such as
        tcp://pynq:4810, with its token in the environment variable VOXRT_BOARD_TOKEN.
    config
        The configuration of the simulated hardware: tiny has no optional features, lit has all of them.
    host
        Address to listen on. Every address but loopback needs a token.
    port
        TCP port of the page; 0 takes a free one.
    token
        The token that clients must send. Where one is needed and not given, a random one is made and printed. Other
        users of this machine see it in the command line.
    token_file
        A file whose first line is the token.
    origin
        Further origins (http://NAME:PORT) whose pages may connect, such as that of a reverse proxy. This machine's own
        addresses and names need no option.
    legacy_port
        TCP port of the legacy protocol, for the desktop client of the original project: 28 bytes in, a raw picture of
        512x512 pixels out, no token.
    depth
        Levels of the octrees of assets.
    reporting
        The form of the output: --json prints the address of the page on standard output.
    """
    from voxrt.board.errors import Refused  # noqa: PLC0415
    from voxrt.boards.board_scenes import asset_reader  # noqa: PLC0415 - it imports NumPy
    from voxrt.serve.scene_library import SceneLibrary, scene_names  # noqa: PLC0415
    from voxrt.serve.server_options import ServerOptions  # noqa: PLC0415
    from voxrt.serve.token import choose_token  # noqa: PLC0415

    for option, value in (("--port", port), ("--legacy-port", legacy_port)):
        if value is not None and not 0 <= value < 1 << 16:
            raise UsageError(f"{option} {value} is not 0 to 65535")
    if depth is not None and not 1 <= depth <= 16:
        raise UsageError(f"--depth {depth} is not 1 to 16")
    try:
        token = choose_token(host, token, token_file)
    except Refused as refusal:
        raise UsageError(str(refusal)) from refusal
    first = _read_first(scenes[0], depth) if scenes else None
    named = {name: _files(path) for name, path in scene_names(scenes or _examples()).items()}
    library = SceneLibrary(asset_reader(depth), named, asset_reader(depth, memory_depth=depth))
    options = ServerOptions(host, port, token, origin, legacy_port)
    opened = open_device(device, config)
    gc.set_threshold(USUAL_GARBAGE)
    with contextlib.suppress(asyncio.CancelledError):
        asyncio.run(_serve(opened, first, library, options, json=reporting.json))


def _examples() -> list[Path]:
    """Return the example scenes that are installed with voxrt; in a checkout they are links."""
    from voxrt.boards.board_scenes import ASSET_READER_SUFFIXES  # noqa: PLC0415 - it imports NumPy

    folder = Path(voxrt.__file__).with_name("example_scenes")
    return sorted(path.resolve() for path in folder.iterdir() if path.suffix in ASSET_READER_SUFFIXES)


def open_device(name: str, config: str) -> Device:
    """Open a device: ``model``, ``sim``, ``serial:PORT`` or ``tcp://BOARD:PORT``."""
    from voxrt.board.errors import DeviceError  # noqa: PLC0415 - it imports NumPy
    from voxrt.board.simulated.core import open_rtl  # noqa: PLC0415
    from voxrt.board.simulated.model import ModelDevice  # noqa: PLC0415
    from voxrt.board.tcp_device import TOKEN_VARIABLE, open_tcp  # noqa: PLC0415

    if name.lower() == "model":
        return ModelDevice()
    if name.lower() == "sim":
        return open_rtl(config)
    try:
        if name.startswith(SERIAL):
            return open_serial_device(name.removeprefix(SERIAL))
        if name.startswith(TCP):
            return open_tcp(name, os.environ.get(TOKEN_VARIABLE, ""))
    except DeviceError as error:
        raise voxrt.SimulatorError(str(error)) from error
    raise UsageError(f"--device {name} is no device; there are model, sim, serial:PORT and tcp://BOARD:PORT")


def open_serial_device(port: str) -> SerialDevice:
    """Open the board at a serial line.

    Raises
    ------
    DeviceError
        There is no port of this name, or no board of voxrt at it.
    """
    from voxrt.board.designs.serial_device import SerialDevice  # noqa: PLC0415
    from voxrt.board.designs.serial_link import open_serial  # noqa: PLC0415
    from voxrt.board.simulated.model import ModelDevice  # noqa: PLC0415

    return SerialDevice(open_serial(port), ModelDevice())


def _read_first(path: Path, depth: int | None) -> Scene:
    from voxrt.boards.board_scenes import load_scene  # noqa: PLC0415

    try:
        return load_scene(path, depth)
    except OSError as error:
        raise voxrt.RomError(f"{path}: {error}") from error


def _files(path: Path) -> list[Path]:
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
    from voxrt.board.errors import DeviceError, Refused  # noqa: PLC0415
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
    except Refused as refusal:
        raise voxrt.DoesNotFitError(str(refusal)) from refusal
    except DeviceError as error:
        raise voxrt.SimulatorError(str(error)) from error
    except OSError as error:
        raise UsageError(
            f"cannot listen on {options.host} port {options.port}: {error.strerror or error}; choose another --port"
        ) from error
