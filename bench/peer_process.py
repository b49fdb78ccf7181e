"""One confined process: how long it took, and how much memory it had, or why it failed."""

from __future__ import annotations

import os
import resource
import subprocess
import tempfile
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
        process = subprocess.Popen(command, stdout=out, stderr=err, env=USER_ENVIRONMENT, preexec_fn=confine)  # noqa: PLW1509 - no threads
        while (ended := os.wait4(process.pid, os.WNOHANG))[0] == 0:
            if time.perf_counter() - start > seconds:
                process.kill()
                os.wait4(process.pid, 0)
                process.returncode = -1
                return f"more than {seconds:g} s"
            time.sleep(0.002)
        wall = time.perf_counter() - start
        process.returncode = os.waitstatus_to_exitcode(ended[1])
        for stream in (out, err):
            stream.seek(0)
        if process.returncode != 0:
            errors = err.read().decode("utf-8", "replace")
            died = process.returncode < 0 and "Error" not in errors
            return "out of memory" if died or any(word in errors for word in NO_MEMORY) else errors.splitlines()[-1]
        return Ended(wall, ended[2].ru_maxrss / 1024, out.read().decode("utf-8", "replace"))
