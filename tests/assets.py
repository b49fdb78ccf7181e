"""Where the real-world assets lie; tests that want one are skipped with a message where it is absent."""

import os
from pathlib import Path

import pytest

SHARED = Path(__file__).resolve().parents[2] / "shared"
ROOT = Path(os.environ.get("VOXRT_ASSETS", SHARED / "assets"))


def asset(name: str) -> Path:
    path = ROOT / name
    if not path.exists():
        pytest.skip(f"asset {name} is not in {ROOT}")
    return path


def seed_memory(name: str) -> Path:
    path = SHARED / "seed-memories" / name
    if not path.exists():
        pytest.skip(f"seed memory {name} is not in {SHARED}")
    return path
