"""A running ``voxrt serve`` in a process of its own, with a temporary folder of its own."""

from __future__ import annotations

import asyncio
import json
import os
import re
import resource
import signal
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

WAIT = 60.0
"""Seconds that a test waits at most for what must happen."""


class Serving:
    """The process, its addresses, and what can be seen of it from outside."""

    def __init__(self, process, report, temporary: Path, errors: Path) -> None:
        self.process = process
        self.url: str = report["url"]
        self.urls: list[str] = report["urls"]
        self.port: int = report["port"]
        self.legacy_port = report["legacy_port"]
        self.temporary = temporary
        self._errors = errors

    @property
    def log(self) -> str:
        """What it has said on standard error, besides where it serves."""
        lines = self._errors.read_text().splitlines()
        return "\n".join(line for line in lines if not re.match(r"serving |  (page|legacy) ", line))

    def megabytes(self) -> float:
        status = Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+) kB", status)[1]) / 1024

    def open_files(self) -> int:
        return len(list(Path(f"/proc/{self.process.pid}/fd").iterdir()))

    def children(self) -> list[int]:
        """Processes that it or its children started."""
        found, waiting = [], [self.process.pid]
        while waiting:
            for thread in Path(f"/proc/{waiting.pop()}/task").glob("*/children"):
                started = [int(pid) for pid in thread.read_text().split()]
                found += started
                waiting += started
        return found

    def leftovers(self) -> list[str]:
        """What it has left in the temporary folder."""
        return sorted(path.name for path in self.temporary.iterdir())

    def interrupt(self) -> int:
        """End it by Ctrl-C; return its exit code."""
        self.process.send_signal(signal.SIGINT)
        return self.process.wait(WAIT)


@contextmanager
def serving(folder: Path, *arguments, file_bytes: int | None = None):
    """A running server; killed at the end, where the test has not ended it."""
    temporary = folder / "temporary"
    temporary.mkdir()
    errors = folder / "errors.txt"

    def limit() -> None:
        if file_bytes is not None:
            resource.setrlimit(resource.RLIMIT_FSIZE, (file_bytes, file_bytes))

    command = [sys.executable, "-m", "voxrt", "serve", *map(str, arguments), "--port", "0", "--json"]
    with (
        errors.open("w") as log,
        subprocess.Popen(
            command,
            cwd=folder,
            env={**os.environ, "TMPDIR": str(temporary)},
            stdout=subprocess.PIPE,
            stderr=log,
            text=True,
            preexec_fn=limit,  # noqa: PLW1509 - the tests' process has no threads then
        ) as process,
    ):
        try:
            lines = []
            for line in process.stdout:
                lines.append(line)
                if line.startswith("}"):
                    break
            assert lines, errors.read_text()
            yield Serving(process, json.loads("".join(lines)), temporary, errors)
        finally:
            process.kill()


async def until(condition) -> None:
    """Wait until a condition holds, for a bounded time."""
    async with asyncio.timeout(WAIT):
        while not condition():  # noqa: ASYNC110 - it looks at another process
            await asyncio.sleep(0.02)
