"""``voxrt-board BITSTREAM [SCENE ...]``: the frame server on a PYNQ board."""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import sys
from pathlib import Path

from ..board.errors import DeviceError, Refused
from ..board.pynq_device import open_pynq
from .scene_files import read_memory
from .scene_library import SceneLibrary, scene_names
from .scene_process import memory_reader
from .server import FrameServer
from .server_options import ServerOptions
from .token import choose_token


def main() -> int:
    """Serve until interrupted; print an error in one line."""
    parser = argparse.ArgumentParser(
        prog="voxrt-board", description="Show scenes of a PYNQ board live in the browser. Ctrl-C ends the server."
    )
    parser.add_argument("bitstream", help="the .bit of the ray tracer, with its .hwh in the same folder")
    parser.add_argument(
        "scenes",
        nargs="*",
        type=Path,
        help="blobs, and .mem files with their .json in the same folder; the first is shown at once",
    )
    parser.add_argument(
        "--host", default="127.0.0.1", help="address to listen on; every one but loopback needs a token"
    )
    parser.add_argument("--port", type=int, default=8080, help="TCP port of the page")
    parser.add_argument(
        "--token",
        help="token that clients must send; default: a random one where a token is needed. Other users of the machine "
        "see the command line",
    )
    parser.add_argument("--token-file", type=Path, help="file whose first line is the token")
    parser.add_argument(
        "--origin", action="append", default=[], help="further origin (http://NAME:PORT) whose pages may connect"
    )
    parser.add_argument(
        "--legacy-port",
        type=int,
        help="TCP port of the legacy protocol, for the desktop client of the original project; it has no token",
    )
    arguments = parser.parse_args()
    try:
        token = choose_token(arguments.host, arguments.token, arguments.token_file)
        options = ServerOptions(arguments.host, arguments.port, token, tuple(arguments.origin), arguments.legacy_port)
        with contextlib.suppress(KeyboardInterrupt):
            asyncio.run(_serve(arguments.bitstream, arguments.scenes, options))
    except (Refused, DeviceError, OSError) as error:
        sys.stderr.write(f"voxrt-board: error: {error}\n")
        return 1
    return 0


async def _serve(bitstream: str, scenes: list[Path], options: ServerOptions) -> None:
    library = SceneLibrary(memory_reader(), {name: _files(path) for name, path in scene_names(scenes).items()})
    async with FrameServer(open_pynq(bitstream), library, options) as server:
        for path in scenes[:1]:
            await server.session.renderer.load(read_memory(_files(path), _ignore_progress), _ignore_progress)
        sys.stderr.write(f"serving at {' or '.join(server.urls)}; Ctrl-C ends it\n")
        await asyncio.Event().wait()


def _files(path: Path) -> list[Path]:
    """Return the file of a scene, and the manifest of a ``.mem``."""
    return [path, path.with_suffix(".json")] if path.suffix.lower() == ".mem" else [path]


def _ignore_progress(_stage: str, _done: int, _total: int) -> None:
    pass


if __name__ == "__main__":
    sys.exit(main())
