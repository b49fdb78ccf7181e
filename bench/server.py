"""Frames a second and latency of the frame server on the exact model, at 640x480 on this machine's cores.

    python bench/server.py SCENE [SECONDS]

SCENE is a memory or an asset. A viewer on loopback first takes frames as fast as they come, then turns the camera step
by step and waits for each step's frame: from the request to the whole frame in the viewer's hands. The original
took 200 ms (report, section 5.2.3).
"""

from __future__ import annotations

import asyncio
import math
import statistics
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING

from voxrt.board.simulated.model import ModelDevice
from voxrt.serve.client import visit
from voxrt.serve.server import FrameServer, Listening
from voxrt.serve.show import Program
from voxrt.staging import BuildingReader, load_scene

if TYPE_CHECKING:
    from voxrt.serve.client import Client

ORIGINAL_LATENCY = 0.2
STEPS = 100


async def measure(scene_file: Path, seconds: float) -> None:
    """Print the figures of one scene."""
    async with FrameServer(ModelDevice(), Program(BuildingReader()), Listening()) as server:
        await server.show.stage.put_on(load_scene(scene_file), lambda _stage, _done, _total: None)
        async with visit(server.url) as client:
            await client.take()
            frames = await count_frames(client, seconds)
            latencies = sorted(await turn(client))
    print(f"{scene_file.name}, 640x480: {frames / seconds:.1f} frames per second")
    middle, slow = statistics.median(latencies), latencies[math.ceil(0.95 * STEPS) - 1]
    print(f"request to frame: {1000 * middle:.1f} ms in the middle, {1000 * slow:.1f} ms for 95 of 100;")
    print(f"the original's 200 ms are {ORIGINAL_LATENCY / middle:.1f} times the middle")


async def count_frames(client: Client, seconds: float) -> int:
    """Count the frames that arrive."""
    await client.ask("view", nonstop=True)
    await client.frame()
    end = time.perf_counter() + seconds
    frames = 0
    while time.perf_counter() < end:
        await client.frame()
        frames += 1
    await client.ask("view", nonstop=False)
    return frames


async def turn(client: Client) -> list[float]:
    """Move the camera step by step; seconds that each took to be seen."""
    camera = client.state["view"]["camera"]
    latencies = []
    for step in range(STEPS):
        moved = {**camera, "position": [value + step for value in camera["position"]]}
        started = time.perf_counter()
        request = await client.send("view", camera=moved)
        while (await client.frame()).request != request:
            pass
        latencies.append(time.perf_counter() - started)
    return latencies


if __name__ == "__main__":
    asyncio.run(measure(Path(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else 5.0))
