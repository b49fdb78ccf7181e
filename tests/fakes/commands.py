"""The commands as a user runs them, in a folder of their own."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

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


class Voxrt:
    """The command, as a function of its arguments."""

    def __init__(self, command: Callable[..., Finished]) -> None:
        self._command = command

    def __call__(self, *arguments: object, **settings: object) -> Finished:
        return self._command(*arguments, **settings)

    def succeeds(self, *arguments: object, **settings: object) -> Finished:
        finished = self(*arguments, **settings)
        assert finished.code == 0, finished.err
        return finished

    def json(self, *arguments: object) -> Any:
        """What a command that succeeds prints with `--json`."""
        return json.loads(self.succeeds(*arguments, "--json").out)

    def fails(self, code: int, problem: str, *arguments: object) -> Finished:
        """All that it says is one line with the problem."""
        finished = self(*arguments)
        assert (finished.code, finished.out) == (code, ""), finished
        assert finished.error.startswith("voxrt: error: "), finished.error
        assert problem in finished.error, finished.error
        return finished


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
    yield Voxrt(command)
    for number, handler in handlers.items():
        signal.signal(number, handler)


@pytest.fixture
def built(voxrt: Voxrt, folder: Path) -> Path:
    """The folder, with house.mem of 32 voxels per side."""
    voxrt.succeeds("build", "house.obj", "--depth", "5")
    return folder


@pytest.fixture
def process(folder: Path) -> Voxrt:
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

    return Voxrt(command)
