"""Commands of voxrt that take a while, each in a process of its own, so that Blender goes on."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from typing import TYPE_CHECKING, Protocol

import bpy

if TYPE_CHECKING:
    from collections.abc import Sequence

_SECONDS = 0.2  # between looks at a command that runs


class Work(Protocol):
    """What takes a while, beside what Blender does."""

    @property
    def ended(self) -> bool:
        """Whether it has ended."""

    def outcome(self) -> tuple[bool, str]:
        """Wait for its end. Return whether it did what it should, and a line about it."""

    def stop(self) -> None:
        """End it, or let it end by itself."""


class RunningCommand:
    """``voxrt ARGUMENTS`` in a process of its own, by the Python of Blender, with the packages that it has.

    `folder` holds files that it reads; it is removed at the end. `stdin` is its standard input: that of
    :meth:`write` for ``subprocess.PIPE``.
    """

    def __init__(
        self, arguments: Sequence[str], folder: tempfile.TemporaryDirectory[str], stdin: int = subprocess.DEVNULL
    ) -> None:
        self._folder = folder
        self._text = ""
        # It lives as long as the process. What is appended does not depend on what we have read.
        self._printed = tempfile.TemporaryFile("a+b")  # noqa: SIM115
        self._process = subprocess.Popen(  # noqa: S603 - our own module
            [sys.executable, "-m", "voxrt", *arguments],
            stdin=stdin,
            stdout=self._printed,
            stderr=subprocess.STDOUT,
            env=os.environ | {"PYTHONPATH": os.pathsep.join(one for one in sys.path if one)},
        )

    @property
    def ended(self) -> bool:
        """Whether it has ended."""
        return self._process.poll() is not None

    def write(self, text: str) -> None:
        """Write to its standard input."""
        assert self._process.stdin is not None
        self._process.stdin.write(text.encode())
        self._process.stdin.flush()

    def close_input(self) -> None:
        """End its standard input."""
        assert self._process.stdin is not None
        self._process.stdin.close()

    def printed(self) -> str:
        """Return what it has printed until now."""
        if not self._printed.closed:
            self._printed.seek(0)
            self._text = self._printed.read().decode(errors="replace")
        return self._text

    def outcome(self) -> tuple[bool, str]:
        """Wait for its end. Return whether it did what it should, and the last line that it printed."""
        status = self._process.wait()
        lines = [line for line in self.printed().splitlines() if line.strip()]
        self._clean()
        return status == 0, lines[-1].strip() if lines else ""

    def finish(self, seconds: float) -> None:
        """Wait for its end; end it if that takes longer."""
        try:
            self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._clean()

    def _clean(self) -> None:
        self.printed()
        self._printed.close()
        self._folder.cleanup()

    def stop(self) -> None:
        """End it."""
        self._process.kill()
        self.finish(_SECONDS)


class Watch:
    """The command that runs, of which the panel shows the last line. Another one ends it.

    Attributes
    ----------
    line
        What the panel says.
    """

    def __init__(self) -> None:
        self.line = ""
        self._command: Work | None = None

    def follow(self, command: Work) -> None:
        """Wait for a command, beside what Blender does."""
        self.stop()
        self._command, self.line = command, "running"
        if not bpy.app.timers.is_registered(look):
            bpy.app.timers.register(look, first_interval=_SECONDS)

    def look(self) -> float | None:
        """Take over what the command printed if it has ended; return the seconds until the next look: a timer."""
        if self._command is None:
            return None
        if not self._command.ended:
            return _SECONDS
        _, self.line = self._command.outcome()
        self._command = None
        return None

    def stop(self) -> None:
        """End the command that runs."""
        if self._command is not None:
            self._command.stop()
            self._command = None


WATCH = Watch()


def look() -> float | None:
    """Look at the command: a timer, which Blender knows by its address."""
    return WATCH.look()
