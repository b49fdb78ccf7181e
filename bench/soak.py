"""The frame server under everything at once, and whether its memory stays flat.

    python bench/soak.py [--minutes N | --rounds N] [--device model|sim] [--write]

A server in a process of its own shows a scene. In every round, all at the same time: a controller turns the camera and
puts the other of two scenes on; four watchers must each see a new frame; visitors come and go, politely and not; others
read nothing; strangers send garbage, half handshakes, oversized headers and messages, requests that are none; the
original's client asks for a picture. Then the server's resident memory is read. At the end nobody may be left in the
server, no file open that was not open at first, and the memory of the last three quarters of the run, as a straight
line, may grow by no more than 4 MB. ``--write`` puts the figures into ``bench/results/soak.md`` as well.
"""

from __future__ import annotations

import argparse
import asyncio
import collections
import contextlib
import json
import platform
import re
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed

import voxrt
from voxrt.board.errors import Refused
from voxrt.serve.client import visit
from voxrt.serve.packets import CHUNK_LIMIT

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from voxrt.serve.client import Client

RESULTS = Path(__file__).resolve().parent / "results" / "soak.md"
SCENE = Path(__file__).resolve().parents[1] / "examples" / "courtyard.glb"
SIZE = [320, 240]
WATCHERS = 4
TURNS = 10
GROWTH_LIMIT = 4.0  # MB
LEGACY_REQUEST = struct.pack("<7I", *[0x7FF000] * 6, 0)


class Process:
    """The server's process, looked at from outside."""

    def __init__(self, scene: Path, device: str) -> None:
        command = [sys.executable, "-m", "voxrt", "serve", scene, "--device", device]
        command += ["--port", "0", "--legacy-port", "0", "--json"]
        self.running = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        assert self.running.stdout is not None
        lines = []
        for line in self.running.stdout:
            lines.append(line)
            if line.startswith("}"):
                break
        told = json.loads("".join(lines))
        self.url: str = told["url"]
        self.port: int = told["port"]
        self.legacy_port: int = told["legacy_port"]

    def megabytes(self) -> float:
        """Resident memory."""
        status = Path(f"/proc/{self.running.pid}/status").read_text()
        found = re.search(r"VmRSS:\s+(\d+) kB", status)
        assert found is not None
        return int(found[1]) / 1024

    def open_files(self) -> int:
        """File descriptors."""
        return len(list(Path(f"/proc/{self.running.pid}/fd").iterdir()))

    def end(self) -> int:
        """Interrupt it; its exit code."""
        self.running.send_signal(2)
        return self.running.wait(60)


class Soak:
    """What goes on around a server, and what was counted of it."""

    def __init__(self, server: Process, scenes: list[dict[str, bytes]]) -> None:
        self.server = server
        self.scenes = scenes
        self.counted: collections.Counter[str] = collections.Counter()
        self.random = np.random.default_rng(1)
        self.seen = [asyncio.Event() for _ in range(WATCHERS)]

    async def round(self, controller: Client) -> None:
        """Do everything once, at the same time; the watchers go on by themselves, and each sees a frame."""
        for seen in self.seen:
            seen.clear()
        await asyncio.gather(
            self.steer(controller),
            *(self.come_and_go(abruptly=number % 2 == 1) for number in range(4)),
            self.read_nothing(),
            self.talk_nonsense(),
            *(self.garbage(request) for request in self.openings()),
            self.legacy(LEGACY_REQUEST),
            self.legacy(LEGACY_REQUEST[:11]),
        )
        for seen in self.seen:
            await seen.wait()
        self.counted["rounds"] += 1

    async def steer(self, client: Client) -> None:
        """Turn, see every turn, and put the other scene on."""
        camera = client.state["view"]["camera"]
        for turn in range(TURNS):
            position = [value + turn for value in camera["position"]]
            request = await client.send("view", camera={**camera, "position": position})
            while (await client.frame()).request != request:
                self.counted["frames seen"] += 1
            self.counted["frames seen"] += 1
        await client.upload(self.scenes[(self.counted["scenes put on"] + 1) % 2], lambda _stage, _done, _total: None)
        self.counted["scenes put on"] += 1

    async def watch(self, watcher: int) -> None:
        """See frames without end, all of them in order."""
        async with visit(self.server.url) as client:
            last = 0
            try:
                while True:
                    sequence = (await client.frame()).sequence
                    assert sequence > last
                    last = sequence
                    self.seen[watcher].set()
                    self.counted["frames seen"] += 1
            finally:
                hang_up(client)  # what has not been read would be in the way of a farewell

    async def come_and_go(self, *, abruptly: bool) -> None:
        """Visit, see a frame, and leave or hang up."""
        with contextlib.suppress(Refused):
            async with visit(self.server.url) as client:
                await client.frame()
                self.counted["visits"] += 1
                self.counted["frames seen"] += 1
                if abruptly:
                    hang_up(client)

    async def read_nothing(self) -> None:
        """Visit and leave everything unread for a while."""
        address = f"ws://127.0.0.1:{self.server.port}/v1"
        async with connect(address, proxy=None, compression=None, max_queue=1) as slow:
            slow.transport.pause_reading()
            await asyncio.sleep(0.3)
            slow.transport.abort()
        self.counted["visitors who read nothing"] += 1

    async def talk_nonsense(self) -> None:
        """Visit, and send what is no request; last what is too long."""
        address = f"ws://127.0.0.1:{self.server.port}/v1"
        async with connect(address, proxy=None, compression=None) as visitor:
            for _ in range(10):
                await visitor.send(self.random.bytes(int(self.random.integers(0, 200))))
                await visitor.send('{"type": "view", "camera": 3}')
            await visitor.send(bytes(CHUNK_LIMIT + 100))
            async with asyncio.timeout(30):
                with contextlib.suppress(ConnectionClosed):
                    while True:
                        await visitor.recv()
        self.counted["visitors who talk nonsense"] += 1

    def openings(self) -> list[bytes]:
        """Give what strangers send before they hang up."""
        return [
            b"",
            self.random.bytes(int(self.random.integers(1, 400))),
            b"GET /v1 HTTP/1.1\r\nHost:",
            b"GET / HTTP/1.1\r\nX: " + b"a" * 100_000 + b"\r\n\r\n",
            b"GET / HTTP/1.1\r\nHost: x\r\n\r\n",
        ]

    async def garbage(self, request: bytes) -> None:
        """Connect, send something, take what comes, hang up."""
        async with self._socket(self.server.port) as (reader, writer):
            writer.write(request)
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(reader.read(1000), 0.2)
        self.counted["strangers"] += 1

    async def legacy(self, request: bytes) -> None:
        """Ask for a picture as the original's client does; a request cut short is hung up."""
        async with self._socket(self.server.legacy_port) as (reader, writer):
            writer.write(request)
            if len(request) == len(LEGACY_REQUEST):
                await reader.readexactly(3 * 512 * 512)
                self.counted["pictures for the original's client"] += 1

    @contextlib.asynccontextmanager
    async def _socket(self, port: int) -> AsyncIterator[tuple[asyncio.StreamReader, asyncio.StreamWriter]]:
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        try:
            yield reader, writer
        except ConnectionError:
            pass
        finally:
            writer.transport.abort()


def hang_up(client: Client) -> None:
    """Leave without a word."""
    client._connection.transport.abort()  # noqa: SLF001 - clients say goodbye


async def soak(around: Soak, minutes: float, rounds: int | None) -> list[tuple[float, float]]:
    """Go on for so long, or so many rounds: seconds and the server's megabytes after each."""
    samples: list[tuple[float, float]] = []
    async with asyncio.TaskGroup() as group, visit(around.server.url) as controller:
        await controller.take()
        await controller.ask("view", size=SIZE, nonstop=True)
        watching = [group.create_task(around.watch(number)) for number in range(WATCHERS)]
        for seen in around.seen:
            await seen.wait()
        files = around.server.open_files()
        began = time.monotonic()
        while time.monotonic() - began < 60 * minutes if rounds is None else len(samples) < rounds:
            async with asyncio.timeout(60):
                await around.round(controller)
            samples.append((time.monotonic() - began, around.server.megabytes()))
        async with asyncio.timeout(60):
            while (counters := (await controller.ask("counters"))["counters"])["viewers"] > 1 + WATCHERS:
                await controller.frame()
            while around.server.open_files() > files:
                await controller.frame()
        for task in watching:
            task.cancel()
        around.counted["frames rendered"] = counters["frames"]
        around.counted["frames dropped for slow viewers"] = counters["dropped"]
        hang_up(controller)
    return samples


def growth(samples: list[tuple[float, float]]) -> float:
    """Give by how many megabytes the straight line through the last three quarters of the samples rises."""
    kept = np.array(samples[len(samples) // 4 :])
    slope = np.polyfit(kept[:, 0], kept[:, 1], 1)[0] if len(kept) > 2 else 0.0
    return float(slope * (kept[-1, 0] - kept[0, 0]))


def report(around: Soak, device: str, samples: list[tuple[float, float]]) -> str:
    """Put the figures into a table."""
    seconds = samples[-1][0]
    quarter = len(samples) // 4
    rows = [
        ("machine", f"{platform.machine()}, Python {platform.python_version()}"),
        ("device", f"{device}, {SIZE[0]}x{SIZE[1]} pixels, without end"),
        ("time", f"{seconds / 60:.1f} minutes"),
        *((name, f"{count:,}") for name, count in around.counted.items()),
        ("resident memory after a quarter", f"{samples[quarter][1]:.1f} MB"),
        ("resident memory at the end", f"{samples[-1][1]:.1f} MB"),
        ("growth of the line through the last three quarters", f"{growth(samples):+.2f} MB"),
    ]
    lines = ["# The frame server under load, by bench/soak.py", "", "| what | measured |", "|---|---|"]
    return "\n".join([*lines, *(f"| {name} | {value} |" for name, value in rows), ""])


def main() -> int:
    """Soak; 1 when the memory grew."""
    parser = argparse.ArgumentParser(description="Load a frame server and watch its memory.")
    parser.add_argument("--minutes", type=float, default=2.0)
    parser.add_argument("--rounds", type=int)
    parser.add_argument("--device", choices=("model", "sim"), default="model")
    parser.add_argument("--write", action="store_true")
    said = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scenes = []
        for number in range(2):
            voxrt.build(SCENE, folder / str(number), depth=6 + number)
            scenes.append({file.name: file.read_bytes() for file in sorted((folder / str(number)).iterdir())})
        server = Process(folder / "0" / f"{SCENE.stem}.mem", said.device)
        try:
            around = Soak(server, scenes)
            samples = asyncio.run(soak(around, said.minutes, said.rounds))
        finally:
            code = server.end()
    text = report(around, said.device, samples)
    print(text)
    if said.write:
        RESULTS.write_text(text)
    return int(code != 0 or growth(samples) > GROWTH_LIMIT)


if __name__ == "__main__":
    sys.exit(main())
