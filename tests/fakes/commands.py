"""The commands as a user runs them, in a folder of their own."""

from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Protocol

import pytest

from voxrt.cli.run import run

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

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
    def __call__(self, *arguments: object) -> Finished: ...


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The folder that the commands run in: house.obj and dog.usda are there."""
    for name in ("house.obj", "house.mtl", "dog.usda"):
        shutil.copy(EXAMPLES / name, tmp_path)
    return tmp_path


@pytest.fixture
def voxrt(folder: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]) -> Iterator[Voxrt]:
    """``voxrt`` within the test's process: all but its start and its end."""

    def command(*arguments: object) -> Finished:
        capfd.readouterr()
        code = run([str(argument) for argument in arguments])
        return Finished(int(code), *capfd.readouterr())

    monkeypatch.chdir(folder)
    monkeypatch.setattr(sys, "unraisablehook", sys.unraisablehook)
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)}
    yield command
    for number, handler in handlers.items():
        signal.signal(number, handler)


@pytest.fixture
def process(folder: Path) -> Callable[..., Finished]:
    """``voxrt`` in a process of its own."""

    def command(*arguments: object, env: dict[str, str] | None = None) -> Finished:
        finished = subprocess.run(
            [sys.executable, "-m", "voxrt", *map(os.fsencode, map(str, arguments))],
            cwd=folder,
            env={**os.environ, **(env or {})},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            check=False,
            timeout=300,
        )
        return Finished(finished.returncode, finished.stdout.decode(), finished.stderr.decode())

    return command
