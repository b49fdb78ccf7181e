"""One confined process: how long it took, and how much memory it had, or why it failed."""

from __future__ import annotations

import os
import resource
import signal
import subprocess
import tempfile
import threading
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

from report import USER_ENVIRONMENT

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

NO_MEMORY = ("MemoryError", "bad_alloc", "Unable to allocate", "Cannot allocate memory", "out of memory")


@dataclass(frozen=True)
class Ended:
    """A process that ended well."""

    wall: float
    """Seconds."""
    peak: float
    """Most resident memory, MB."""
    printed: str


def run_confined(command: Sequence[str | Path], seconds: float, memory: int) -> Ended | str:
    """Run a command in at most so many seconds and bytes of address space, or tell why it failed."""

    def confine() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        start = time.perf_counter()
        process = subprocess.Popen(command, stdout=out, stderr=err, env=USER_ENVIRONMENT, preexec_fn=confine)  # noqa: PLW1509 - no threads yet
        limit = threading.Timer(seconds, os.kill, (process.pid, signal.SIGKILL))
        limit.start()
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - start
        limit.cancel()
        limit.join()
        process.returncode = os.waitstatus_to_exitcode(status)
        if wall > seconds:
            return f"more than {seconds:g} s"
        for stream in (out, err):
            stream.seek(0)
        if process.returncode != 0:
            errors = err.read().decode("utf-8", "replace")
            died = process.returncode < 0 and "Error" not in errors
            return "out of memory" if died or any(word in errors for word in NO_MEMORY) else errors.splitlines()[-1]
        return Ended(wall, usage.ru_maxrss / 1024, out.read().decode("utf-8", "replace"))
