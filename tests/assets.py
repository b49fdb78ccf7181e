"""Real third-party assets: where they stand, and a skip with a message where they do not."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

ROOT = Path(os.environ.get("VOXRT_ASSETS", Path(__file__).resolve().parents[1].parent / "shared" / "assets"))


def asset(name: str) -> Path:
    """The asset `name` (a path below the folder of assets); skips the test where it is absent."""
    path = ROOT / name
    if not path.exists():
        pytest.skip(f"no {name} below {ROOT}; set VOXRT_ASSETS to the folder of assets")
    return path
