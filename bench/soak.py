"""A load test of the frame server: viewers, uploads and attacks; its memory, and the longest gap between two frames.

    python bench/soak.py [--minutes N] [--attacks N] [--device model|sim] [--write]

A server in a process of its own shows a scene, 320x240 pixels without end. Eight polite viewers receive its frames; the
one with control moves the camera and uploads the other of two scenes all the time. Meanwhile there are attacks, one
after the other, evenly over the time, of the kinds in bench/attacks.py. Every second the resident memory of the server
is read. At the end no other viewer may be connected, no additional file may be open, no child may run, and the
temporary folder must be empty. Then Ctrl-C comes in the midst of a build; the time until the server ends is measured.

The memory after the first minute, or after a quarter of a shorter time, may vary by 20 MB. ``--write`` writes the
tables to ``bench/results/soak.md``.
"""

from __future__ import annotations

import argparse
import asyncio
import collections
import contextlib
import os
import platform
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

from attacks import ATTACKS, LONG, Target
from report import write_page

import voxrt
from voxrt.board.errors import Refused
from voxrt.serve.frame_client import open_client

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests"))
from fakes.serving import Serving, serving  # the tests' own server in a process

if TYPE_CHECKING:
    from voxrt.serve.frame_client import FrameClient

SCENE = Path(__file__).resolve().parents[1] / "examples" / "courtyard.glb"
SIZE = [320, 240]
VIEWERS = 8
MEMORY_LIMIT = 20.0  # MB
GAP_LIMIT = 2.0  # seconds, on an idle machine
PAUSE = 0.5  # seconds between two uploads


class Load:
    """The viewers of a server, and what they measure."""

    def __init__(self, server: Serving, scenes: list[dict[str, bytes]]) -> None:
        self.server = server
        self.scenes = scenes
        self.counted: collections.Counter[str] = collections.Counter()
        self.gap = 0.0
        self.attack = "none"
        self.gap_during = "none"
        self.samples: list[tuple[float, float]] = []
        self.code, self.seconds_to_end = 0, 0.0

    async def watch(self, client: FrameClient) -> None:
        """Receive frames without end; check their order and measure the gaps between them."""
        last = (await client.next_frame()).sequence
        seen = time.monotonic()
        while True:
            sequence = (await client.next_frame()).sequence
            assert sequence > last
            now = time.monotonic()
            if now - seen > self.gap:
                self.gap, self.gap_during = now - seen, self.attack
            last, seen = sequence, now
            self.counted["frames received"] += 1

    async def measure_memory(self) -> None:
        """Read the memory every second, without end."""
        began = time.monotonic()
        while True:
            self.samples.append((time.monotonic() - began, self.server.megabytes()))
            await asyncio.sleep(1)

    async def control(self, target: Target) -> None:
        """Move the camera and upload the other scene, without end; attacks that need control wait for their turn."""
        client = target.controller
        while True:
            async with target.turn:
                camera = client.state["view"]["camera"]
                for step in range(10):
                    position = [value + step for value in camera["position"]]
                    await client.request("view", camera={**camera, "position": position})
                number = self.counted["scenes uploaded"] % len(self.scenes)
                await client.upload(self.scenes[number], lambda _stage, _done, _total: None)
                self.counted["scenes uploaded"] += 1
            await asyncio.sleep(PAUSE)

    async def attack_in_turn(self, target: Target, minutes: float, attacks: int) -> None:
        """Attack so many times, evenly over the time."""
        began = time.monotonic()
        kinds = list(ATTACKS.items())
        for number in range(attacks):
            await asyncio.sleep(max(0.0, began + 60 * minutes * (number + 1) / (attacks + 1) - time.monotonic()))
            self.attack, attack = kinds[number % len(kinds)]
            async with asyncio.timeout(600):
                await attack(target)
            self.counted[f"attacks: {self.attack}"] += 1
            self.attack = "none"
        await asyncio.sleep(max(0.0, began + 60 * minutes - time.monotonic()))

    async def run(self, minutes: float, attacks: int) -> None:
        """Run for a time; then see that nothing is left."""
        async with asyncio.TaskGroup() as group, open_client(self.server.url) as controller:
            await controller.take_control()
            await controller.request("view", size=SIZE, nonstop=True)
            await controller.next_frame()
            watching = [group.create_task(self._view()) for _ in range(VIEWERS - 1)]
            while (await controller.request("counters"))["counters"]["viewers"] < VIEWERS:
                await controller.next_frame()
            files = self.server.open_files()
            target = Target(self.server.port, self.server.legacy_port, controller)
            running = [group.create_task(self.control(target)), group.create_task(self.measure_memory())]
            await self.attack_in_turn(target, minutes, attacks)
            async with target.turn, asyncio.timeout(60):
                while (counters := (await controller.request("counters"))["counters"])["viewers"] > VIEWERS:
                    await controller.next_frame()
                while self.server.open_files() > files or self.server.children() or self.server.leftovers():
                    await controller.next_frame()
                for task in (*watching, *running):
                    task.cancel()
            self.counted["frames rendered"] = counters["frames"]
            self.counted["frames that slow viewers missed"] = counters["dropped"]
            await self.interrupt(controller)
            abort(controller)

    async def interrupt(self, client: FrameClient) -> None:
        """End the server by Ctrl-C while it builds an upload and renders without end; measure how long that takes."""
        building = asyncio.Event()
        upload = asyncio.create_task(
            client.upload({"long.obj": LONG}, lambda stage, _d, _t: stage == "voxelize" and building.set())
        )
        async with asyncio.timeout(120):
            await building.wait()
        began = time.monotonic()
        self.code = await asyncio.to_thread(self.server.interrupt)
        self.seconds_to_end = time.monotonic() - began
        with contextlib.suppress(Refused):
            await upload

    async def _view(self) -> None:
        async with open_client(self.server.url) as client:
            try:
                await self.watch(client)
            finally:
                abort(client)


def abort(client: FrameClient) -> None:
    """Abort the connection without a closing handshake: unread frames would delay it."""
    client._connection.transport.abort()  # noqa: SLF001 - FrameClient always closes the connection


def spread(samples: list[tuple[float, float]]) -> float:
    """Return how much the memory varied after the first minute, or after a quarter of a shorter time."""
    first = min(60.0, samples[-1][0] / 4)
    kept = [megabytes for seconds, megabytes in samples if seconds >= first]
    return max(kept) - min(kept)


def report(load: Load, device: str) -> str:
    """Make the tables of the results."""
    seconds = load.samples[-1][0]
    rows = [
        ("machine", f"{platform.machine()}, {os.cpu_count()} processors, Python {platform.python_version()}"),
        ("processes that wanted to run, by the end", f"{os.getloadavg()[2]:.1f} (mean of 15 minutes)"),
        ("device", f"{device}, {SIZE[0]}x{SIZE[1]} pixels, nonstop"),
        ("time", f"{seconds / 60:.1f} minutes"),
        ("viewers", f"{VIEWERS}"),
        *((name, f"{count:,}") for name, count in sorted(load.counted.items()) if not name.startswith("attacks")),
        ("attacks", f"{sum(count for name, count in load.counted.items() if name.startswith('attacks')):,}"),
        ("longest gap between two frames of a viewer", f"{load.gap:.2f} s (attack: {load.gap_during})"),
        ("memory after the first minute varies by", f"{spread(load.samples):.1f} MB"),
        ("from Ctrl-C, in the midst of a build, to the end", f"{load.seconds_to_end:.2f} s"),
        ("what the server logged", f"{len(load.server.log.splitlines())} lines"),
    ]
    step = max(1, len(load.samples) // 15)
    lines = ["# The frame server under load, by bench/soak.py", "", "| what | measured |", "|---|---|"]
    lines += [f"| {name} | {value} |" for name, value in rows]
    lines += ["", "| attack | times |", "|---|--:|"]
    lines += [f"| {name[9:]} | {count} |" for name, count in sorted(load.counted.items()) if name.startswith("attacks")]
    lines += ["", "| seconds | resident memory, MB |", "|--:|--:|"]
    lines += [f"| {at:.0f} | {megabytes:.1f} |" for at, megabytes in load.samples[::step]]
    return "\n".join([*lines, ""])


def main() -> int:
    """Run the load test; return 1 when the memory varied too much."""
    parser = argparse.ArgumentParser(description="Load a frame server, attack it, and measure its memory.")
    parser.add_argument("--minutes", type=float, default=2.0)
    parser.add_argument("--attacks", type=int, default=300)
    parser.add_argument("--device", choices=("model", "sim"), default="model")
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scenes = []
        for number in range(2):
            voxrt.build(SCENE, folder / str(number), depth=6 + number)
            built = sorted((folder / str(number)).glob("*.mem")) + sorted((folder / str(number)).glob("*.json"))
            scenes.append({file.name: file.read_bytes() for file in built})
        first = folder / "0" / f"{SCENE.stem}.mem"
        with serving(folder, first, "--device", arguments.device, "--legacy-port", 0) as server:
            load = Load(server, scenes)
            asyncio.run(load.run(arguments.minutes, arguments.attacks))
            text, log = report(load, arguments.device), server.log
    print(text)
    if log:
        print(f"the server logged:\n{log[:5000]}")
    if load.gap > GAP_LIMIT:
        print(f"a gap of {load.gap:.2f} s is more than {GAP_LIMIT:.0f} s: is the machine idle?")
    if arguments.write:
        write_page("soak.md", text)
    return int(load.code != 0 or spread(load.samples) > MEMORY_LIMIT)


if __name__ == "__main__":
    sys.exit(main())
