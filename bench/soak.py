"""A load test of the frame server: many clients, correct and faulty ones, and the growth of its memory.

    python bench/soak.py [--minutes N | --rounds N] [--device model|sim] [--write]

A server in a process of its own shows a scene. In every round, all at the same time: the client with control moves the
camera and uploads the other of two scenes; four watching clients must each receive a new frame; short-lived clients
connect and leave, with and without closing the connection; one client reads nothing; one sends malformed messages;
connections send noise, incomplete handshakes and oversized headers; a legacy client requests a picture. Then the
resident memory of the server is read. At the end all other clients must be gone and no additional file may be open. A
straight line is fitted to the memory over the last three quarters of the run; it may grow by 4 MB at most. ``--write``
also writes the table to ``bench/results/soak.md``.
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
from voxrt.serve.frame_client import open_client
from voxrt.serve.packets import CHUNK_LIMIT

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from voxrt.serve.frame_client import FrameClient


RESULTS = Path(__file__).resolve().parent / "results" / "soak.md"
SCENE = Path(__file__).resolve().parents[1] / "examples" / "courtyard.glb"
SIZE = [320, 240]
WATCHERS = 4
STEPS = 10
GROWTH_LIMIT = 4.0  # MB
LEGACY_REQUEST = struct.pack("<7I", *[0x7FF000] * 6, 0)


class Process:
    """The process of the server, measured from outside."""

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
        result = json.loads("".join(lines))
        self.url: str = result["url"]
        self.port: int = result["port"]
        self.legacy_port: int = result["legacy_port"]

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
        """Interrupt it; return its exit code."""
        self.running.send_signal(2)
        return self.running.wait(60)


class Load:
    """The clients of a server, and the counts of what they did."""

    def __init__(self, server: Process, scenes: list[dict[str, bytes]]) -> None:
        self.server = server
        self.scenes = scenes
        self.counted: collections.Counter[str] = collections.Counter()
        self.random = np.random.default_rng(1)
        self.received = [asyncio.Event() for _ in range(WATCHERS)]

    async def round(self, controller: FrameClient) -> None:
        """Do everything once, at the same time; each watching client receives a frame."""
        for received in self.received:
            received.clear()
        await asyncio.gather(
            self.move_and_upload(controller),
            *(self.connect_and_leave(abruptly=number % 2 == 1) for number in range(4)),
            self.read_nothing(),
            self.send_malformed(),
            *(self.send_bytes(request) for request in self.faulty_requests()),
            self.legacy(LEGACY_REQUEST),
            self.legacy(LEGACY_REQUEST[:11]),
        )
        for received in self.received:
            await received.wait()
        self.counted["rounds"] += 1

    async def move_and_upload(self, client: FrameClient) -> None:
        """Move the camera, receive a frame for every step, and upload the other scene."""
        camera = client.state["view"]["camera"]
        for step in range(STEPS):
            position = [value + step for value in camera["position"]]
            request = await client.send("view", camera={**camera, "position": position})
            while (await client.next_frame()).request != request:
                self.counted["frames received"] += 1
            self.counted["frames received"] += 1
        await client.upload(self.scenes[(self.counted["scenes uploaded"] + 1) % 2], lambda _stage, _done, _total: None)
        self.counted["scenes uploaded"] += 1

    async def watch(self, watcher: int) -> None:
        """Receive frames without end, and check their order."""
        async with open_client(self.server.url) as client:
            last = 0
            try:
                while True:
                    sequence = (await client.next_frame()).sequence
                    assert sequence > last
                    last = sequence
                    self.received[watcher].set()
                    self.counted["frames received"] += 1
            finally:
                abort(client)  # unread frames would delay a closing handshake

    async def connect_and_leave(self, *, abruptly: bool) -> None:
        """Connect, receive a frame, and close or abort the connection."""
        with contextlib.suppress(Refused):
            async with open_client(self.server.url) as client:
                await client.next_frame()
                self.counted["short connections"] += 1
                self.counted["frames received"] += 1
                if abruptly:
                    abort(client)

    async def read_nothing(self) -> None:
        """Connect and read nothing for a while."""
        address = f"ws://127.0.0.1:{self.server.port}/v2"
        async with connect(address, proxy=None, compression=None, max_queue=1) as slow:
            slow.transport.pause_reading()
            await asyncio.sleep(0.3)
            slow.transport.abort()
        self.counted["clients that read nothing"] += 1

    async def send_malformed(self) -> None:
        """Send malformed messages, and at last one that is too long."""
        address = f"ws://127.0.0.1:{self.server.port}/v2"
        async with connect(address, proxy=None, compression=None) as client:
            for _ in range(10):
                await client.send(self.random.bytes(int(self.random.integers(0, 200))))
                await client.send('{"type": "view", "camera": 3}')
            await client.send(bytes(CHUNK_LIMIT + 100))
            async with asyncio.timeout(30):
                with contextlib.suppress(ConnectionClosed):
                    while True:
                        await client.recv()
        self.counted["clients that send malformed messages"] += 1

    def faulty_requests(self) -> list[bytes]:
        """Return the bytes that faulty connections send."""
        return [
            b"",
            self.random.bytes(int(self.random.integers(1, 400))),
            b"GET /v2 HTTP/1.1\r\nHost:",
            b"GET / HTTP/1.1\r\nX: " + b"a" * 100_000 + b"\r\n\r\n",
            b"GET / HTTP/1.1\r\nHost: x\r\n\r\n",
        ]

    async def send_bytes(self, request: bytes) -> None:
        """Connect, send bytes, read the answer, and abort the connection."""
        async with self._socket(self.server.port) as (reader, writer):
            writer.write(request)
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(reader.read(1000), 0.2)
        self.counted["faulty connections"] += 1

    async def legacy(self, request: bytes) -> None:
        """Request a picture by the legacy protocol; an incomplete request gets none."""
        async with self._socket(self.server.legacy_port) as (reader, writer):
            writer.write(request)
            if len(request) == len(LEGACY_REQUEST):
                await reader.readexactly(3 * 512 * 512)
                self.counted["pictures by the legacy protocol"] += 1

    @contextlib.asynccontextmanager
    async def _socket(self, port: int) -> AsyncIterator[tuple[asyncio.StreamReader, asyncio.StreamWriter]]:
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        try:
            yield reader, writer
        except ConnectionError:
            pass
        finally:
            writer.transport.abort()


def abort(client: FrameClient) -> None:
    """Abort the connection without a closing handshake."""
    client._connection.transport.abort()  # noqa: SLF001 - FrameClient always closes the connection


async def run_load(load: Load, minutes: float, rounds: int | None) -> list[tuple[float, float]]:
    """Run for a time, or for a number of rounds; return (seconds, megabytes of the server) after each round."""
    samples: list[tuple[float, float]] = []
    async with asyncio.TaskGroup() as group, open_client(load.server.url) as controller:
        await controller.take_control()
        await controller.request("view", size=SIZE, nonstop=True)
        watching = [group.create_task(load.watch(number)) for number in range(WATCHERS)]
        for received in load.received:
            await received.wait()
        files = load.server.open_files()
        began = time.monotonic()
        while time.monotonic() - began < 60 * minutes if rounds is None else len(samples) < rounds:
            async with asyncio.timeout(60):
                await load.round(controller)
            samples.append((time.monotonic() - began, load.server.megabytes()))
        async with asyncio.timeout(60):
            while (counters := (await controller.request("counters"))["counters"])["viewers"] > 1 + WATCHERS:
                await controller.next_frame()
            while load.server.open_files() > files:
                await controller.next_frame()
        for task in watching:
            task.cancel()
        load.counted["frames rendered"] = counters["frames"]
        load.counted["frames dropped for slow viewers"] = counters["dropped"]
        abort(controller)
    return samples


def growth(samples: list[tuple[float, float]]) -> float:
    """Return the growth in megabytes: that of a line fitted to the last three quarters of the samples."""
    kept = np.array(samples[len(samples) // 4 :])
    slope = np.polyfit(kept[:, 0], kept[:, 1], 1)[0] if len(kept) > 2 else 0.0
    return float(slope * (kept[-1, 0] - kept[0, 0]))


def report(load: Load, device: str, samples: list[tuple[float, float]]) -> str:
    """Make the table of the results."""
    seconds = samples[-1][0]
    quarter = len(samples) // 4
    rows = [
        ("machine", f"{platform.machine()}, Python {platform.python_version()}"),
        ("device", f"{device}, {SIZE[0]}x{SIZE[1]} pixels, nonstop"),
        ("time", f"{seconds / 60:.1f} minutes"),
        *((name, f"{count:,}") for name, count in load.counted.items()),
        ("resident memory after a quarter of the time", f"{samples[quarter][1]:.1f} MB"),
        ("resident memory at the end", f"{samples[-1][1]:.1f} MB"),
        ("growth, by a line fitted to the last three quarters", f"{growth(samples):+.2f} MB"),
    ]
    lines = ["# The frame server under load, by bench/soak.py", "", "| what | measured |", "|---|---|"]
    return "\n".join([*lines, *(f"| {name} | {value} |" for name, value in rows), ""])


def main() -> int:
    """Run the load test; return 1 when the memory grew."""
    parser = argparse.ArgumentParser(description="Load a frame server and measure its memory.")
    parser.add_argument("--minutes", type=float, default=2.0)
    parser.add_argument("--rounds", type=int)
    parser.add_argument("--device", choices=("model", "sim"), default="model")
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scenes = []
        for number in range(2):
            voxrt.build(SCENE, folder / str(number), depth=6 + number)
            scenes.append({file.name: file.read_bytes() for file in sorted((folder / str(number)).iterdir())})
        server = Process(folder / "0" / f"{SCENE.stem}.mem", arguments.device)
        try:
            load = Load(server, scenes)
            samples = asyncio.run(run_load(load, arguments.minutes, arguments.rounds))
        finally:
            code = server.end()
    text = report(load, arguments.device, samples)
    print(text)
    if arguments.write:
        RESULTS.write_text(text)
    return int(code != 0 or growth(samples) > GROWTH_LIMIT)


if __name__ == "__main__":
    sys.exit(main())
