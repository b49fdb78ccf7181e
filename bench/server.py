"""Frames per second and latency of the frame server on the exact model, 640x480 pixels.

    python bench/server.py SCENE [SECONDS]

SCENE is a memory or an asset. A client on loopback first receives frames as fast as they come. Then it moves the camera
in steps. The latency is the time from a request until the client has received the whole frame. The original project
took 200 ms (report, section 5.2.3).
"""

from __future__ import annotations

import asyncio
import math
import statistics
import sys
import time
from pathlib import Path

from voxrt.board.simulated.model import ModelDevice
from voxrt.boards.board_scenes import asset_reader, load_scene
from voxrt.serve.frame_client import FrameClient, open_client
from voxrt.serve.scene_library import SceneLibrary
from voxrt.serve.server import FrameServer
from voxrt.serve.server_options import ServerOptions

ORIGINAL_LATENCY = 0.2
STEPS = 100


async def measure(scene_file: Path, seconds: float) -> None:
    async with FrameServer(ModelDevice(), SceneLibrary(asset_reader()), ServerOptions()) as server:
        await server.session.renderer.load(load_scene(scene_file), lambda _stage, _done, _total: None)
        async with open_client(server.url) as client:
            await client.take_control()
            frames = await count_frames(client, seconds)
            latencies = sorted(await measure_latency(client))
    print(f"{scene_file.name}, 640x480: {frames / seconds:.1f} frames per second")
    median, slow = statistics.median(latencies), latencies[math.ceil(0.95 * STEPS) - 1]
    print(f"latency: median {1000 * median:.1f} ms, 95th percentile {1000 * slow:.1f} ms")
    print(f"the 200 ms of the original project are {ORIGINAL_LATENCY / median:.1f} times the median")


async def count_frames(client: FrameClient, seconds: float) -> int:
    await client.request("view", nonstop=True)
    await client.next_frame()
    end = time.perf_counter() + seconds
    frames = 0
    while time.perf_counter() < end:
        await client.next_frame()
        frames += 1
    await client.request("view", nonstop=False)
    return frames


async def measure_latency(client: FrameClient) -> list[float]:
    """Move the camera in steps; return the latency of each in seconds."""
    camera = client.state["view"]["camera"]
    latencies = []
    for step in range(STEPS):
        moved = {**camera, "position": [value + step for value in camera["position"]]}
        started = time.perf_counter()
        request = await client.send("view", camera=moved)
        while (await client.next_frame()).request != request:
            pass
        latencies.append(time.perf_counter() - started)
    return latencies


if __name__ == "__main__":
    asyncio.run(measure(Path(sys.argv[1]), float(sys.argv[2]) if len(sys.argv) > 2 else 5.0))
