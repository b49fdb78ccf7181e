"""The static page as `make site` leaves it, and what it makes of files, in Node."""

from __future__ import annotations

import hashlib
import json
import shutil
import subprocess
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

if TYPE_CHECKING:
    from collections.abc import Sequence

    from voxrt import Rom
    from voxrt.octree import Camera

ROOT = Path(__file__).resolve().parents[2]
SITE = ROOT / "build" / "site"


def site() -> Path:
    """The folder of the site; skips the test where it was not built."""
    if not (SITE / "voxrt" / "voxrt.wasm").exists():
        pytest.skip("build/site is not here: make site")
    return SITE


def node(script: str, jobs: Sequence[Any]) -> list[dict[str, Any]]:
    """Let a script of tests/web do jobs in Node; return what comes out of each."""
    if shutil.which("node") is None:
        pytest.skip("no node here: apt install nodejs")
    command = ["node", str(ROOT / "tests" / "web" / script)]
    text = json.dumps({"site": str(site()), "jobs": jobs})
    done = subprocess.run(command, input=text, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    return json.loads(done.stdout)


def page_builds(*files: Sequence[Path], **options: object) -> list[dict[str, Any]]:
    """What the page makes of groups of files that are dropped together, with the same options."""
    jobs = [{"files": [str(file) for file in group], **options} for group in files]
    return node("build_and_render.mjs", jobs)


def sha(array: np.ndarray) -> str:
    return hashlib.sha256(np.ascontiguousarray(array).tobytes()).hexdigest()


def registers_of(camera: Camera) -> dict[str, Sequence[int]]:
    return {name: getattr(camera, name) for name in ("position", "look", "right", "up")}


def assert_same_memory(found: dict[str, Any], rom: Rom) -> None:
    """The page made the words and the materials of a native memory."""
    assert "problem" not in found, found
    assert found["materials"] == [
        {"name": one.name, "colour": list(one.colour), "mirror": one.mirror, "authored": one.authored}
        for one in rom.materials
    ]
    assert (found["depth"], found["words"]) == (rom.octree.depth, sha(rom.octree.words))


def objects_of(built: Any) -> list[dict[str, Any]]:
    """The objects of a native build as the page describes them."""
    return [{"name": one.name, "mode": str(one.mode), "rule": one.rule, "voxels": one.voxels} for one in built.objects]


def warnings_of(warnings: Any) -> list[dict[str, Any]]:
    return [{"kind": one.kind, "message": one.message, "count": one.count} for one in warnings]
