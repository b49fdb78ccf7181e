"""The commands as a user runs them: in a process of their own, in a folder of their own."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple, Protocol

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


class Finished(NamedTuple):
    code: int
    out: str
    err: str

    @property
    def error(self) -> str:
        """The one line that an error is."""
        (line,) = (line for line in self.err.splitlines() if not line.startswith("voxrt: warning: "))
        return line


class Voxrt(Protocol):
    def __call__(self, *arguments: object, env: dict[str, str] | None = None) -> Finished: ...


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The folder that the commands run in: house.obj and dog.usda are there."""
    for name in ("house.obj", "house.mtl", "dog.usda"):
        shutil.copy(EXAMPLES / name, tmp_path)
    return tmp_path


@pytest.fixture
def voxrt(folder: Path) -> Voxrt:
    def run(*arguments: object, env: dict[str, str] | None = None) -> Finished:
        process = subprocess.run(
            [sys.executable, "-m", "voxrt", *map(os.fsencode, map(str, arguments))],
            cwd=folder,
            env={**os.environ, **(env or {})},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            check=False,
            timeout=300,
        )
        return Finished(process.returncode, process.stdout.decode(), process.stderr.decode())

    return run
