"""The static page as `make site` leaves it, and Node."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SITE = ROOT / "build" / "site"


def site() -> Path:
    """The folder of the site; skips the test where it was not built."""
    if not (SITE / "voxrt" / "voxrt.wasm").exists():
        pytest.skip("build/site is not here: make site")
    return SITE


def node(script: Path, value: object, *arguments: str) -> object:
    """Run a script in Node with JSON as its input; return what it prints, JSON too."""
    if shutil.which("node") is None:
        pytest.skip("no node here: apt install nodejs")
    done = subprocess.run(
        ["node", *arguments, str(script)], input=json.dumps(value), capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr[-2000:]
    return json.loads(done.stdout)
