"""``python -m voxrt_board BITSTREAM [SCENE ...]``: the frame server on a PYNQ board."""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import secrets
import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ..board.errors import DeviceError, Refused
from ..board.pynq_device import open_pynq
from .admission import is_loopback
from .scene_files import BoardReader
from .server import FrameServer, Listening
from .show import Program

if TYPE_CHECKING:
    from ..board.scene import Scene


def main() -> int:
    """Serve until interrupted; an error is one line."""
    parser = argparse.ArgumentParser(prog="voxrt-board", description="Show scenes of a PYNQ board live in the browser.")
    parser.add_argument("bitstream", help="the ray tracer's .bit, its .hwh beside it")
    parser.add_argument("scenes", nargs="*", type=Path, help="blobs, and .mem files with their .json beside them")
    parser.add_argument("--host", default="127.0.0.1", help="address to listen on; any but loopback wants a token")
    parser.add_argument("--port", type=int, default=8080, help="TCP port of the page")
    parser.add_argument("--token", help="what viewers must know; made up where it is needed and not given")
    parser.add_argument("--origin", action="append", default=[], help="a further origin whose pages may connect")
    parser.add_argument("--legacy-port", type=int, help="TCP port for the original's desktop client")
    said = parser.parse_args()
    token = said.token if said.token or is_loopback(said.host) else secrets.token_urlsafe(16)
    listening = Listening(said.host, said.port, token, tuple(said.origin), said.legacy_port)
    try:
        with contextlib.suppress(KeyboardInterrupt):
            asyncio.run(_serve(said.bitstream, said.scenes, listening))
    except (Refused, DeviceError, OSError) as error:
        sys.stderr.write(f"voxrt-board: error: {error}\n")
        return 1
    return 0


async def _serve(bitstream: str, scenes: list[Path], listening: Listening) -> None:
    library = {path.stem: partial(_read, path) for path in scenes}
    async with FrameServer(open_pynq(bitstream), Program(BoardReader(), library), listening) as server:
        for path in scenes[:1]:
            await server.show.stage.put_on(_read(path), _quietly)
        sys.stderr.write(f"serving at {server.url}; Ctrl-C ends it\n")
        await asyncio.Event().wait()


def _read(path: Path) -> Scene:
    beside = [path.with_suffix(".json")] if path.suffix == ".mem" else []
    return BoardReader()({file.name: file.read_bytes() for file in (path, *beside)}, _quietly)


def _quietly(_stage: str, _done: int, _total: int) -> None:
    pass


if __name__ == "__main__":
    sys.exit(main())
