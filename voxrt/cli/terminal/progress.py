"""Progress, on standard error: bars that move on a terminal, lines with --verbose."""

from __future__ import annotations

import sys
from contextlib import contextmanager
from time import perf_counter
from typing import TYPE_CHECKING

from voxrt.cli.terminal.messages import is_quiet, is_verbose, note

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from rich.progress import BarColumn, Progress, TaskID

    from voxrt.plans.by_workers import ClusterProgress
    from voxrt.plans.estimate import BuildEstimate

LONG = 60.0
"""Seconds from which a build is announced by an estimate."""

LARGE = 4 << 30
"""Bytes of memory from which it is."""


class BuildBar:
    """The progress of a build: announces one that is long or large, shows the stage and how much of the time has gone.

    `progress` is the bar on the terminal, of which `task` is the task; None for no bar.
    """

    def __init__(self, progress: Progress | None = None, task: TaskID | None = None) -> None:
        self._progress = progress
        self._task = task
        self._stage = ""
        self._begun = 0.0
        self._silent = 0  # workers

    def begin(self, stage: str) -> None:
        """Note that a stage begins."""
        self.end()
        self._stage, self._begun = stage, perf_counter()
        if self._progress is not None and self._task is not None:
            self._progress.update(self._task, description=stage)

    def end(self) -> None:
        """Note that the last stage is done."""
        if self._stage and is_verbose():
            note(f"{self._stage} took {perf_counter() - self._begun:.2f} s")
        self._stage = ""

    def rows(self, done: int, total: int) -> None:
        """Show how many rows of a picture are done; the bar is theirs from now on."""
        if self._progress is not None and self._task is not None:
            self._progress.update(self._task, completed=done, total=total, by_time=False)

    def tiles(self, progress: ClusterProgress) -> None:
        """Show how far a cluster is."""
        text = (
            f"tile {progress.done} of {progress.tiles}, {progress.workers} workers, "
            f"{progress.bytes / (1 << 20):.1f} MB of octrees"
        )
        if progress.silent and progress.silent != self._silent:
            note(
                f"{progress.silent} of {progress.workers} workers have not answered for a while; look whether "
                "they run. Dask gives their tiles to others after some minutes"
            )
        self._silent = progress.silent
        if is_verbose():
            note(text)
        if self._progress is not None and self._task is not None:
            self._progress.update(self._task, description=text)

    def estimate(self, estimate: BuildEstimate) -> None:
        """Announce a build that is long or large; from now on the bar fills within the estimated time."""
        if estimate.seconds > LONG or max(estimate.bytes, estimate.disk) > LARGE:
            note(f"this will take about {estimate}; a smaller --depth or a larger --voxel-size takes less")
        if self._progress is not None and self._task is not None and estimate.seconds > 1:
            self._progress.update(self._task, total=estimate.seconds)


@contextmanager
def build_bar() -> Iterator[BuildBar]:
    """Show the progress of a build."""
    if is_quiet() or is_verbose() or not sys.stderr.isatty():
        bar = BuildBar()
        yield bar
        bar.end()
        return
    from rich.progress import BarColumn, Task  # noqa: PLC0415 - only terminals need it

    class TimeColumn(BarColumn):
        """A bar that fills with the time; it waits just before its end for a build that takes longer."""

        def render(self, task: Task):  # type: ignore[no-untyped-def]  # noqa: ANN202 - as the base class says
            if task.total is not None and task.elapsed is not None and task.fields["by_time"]:
                task.completed = min(task.elapsed, 0.98 * task.total)
            return super().render(task)

    with _terminal_progress(TimeColumn()) as progress:
        yield BuildBar(progress, progress.add_task("", total=None, by_time=True))


@contextmanager
def stage_bar(stages: int) -> Iterator[Callable[[str], None]]:
    """Show which of some stages is reached, on a terminal; yields what to call at each one's begin."""
    begun = -1
    with transfer_bar() as show:

        def begin(stage: str) -> None:
            nonlocal begun
            begun += 1
            show(stage, begun, stages)

        yield begin


@contextmanager
def transfer_bar() -> Iterator[Callable[[str, int, int], None]]:
    """Show how far a transfer is, while standard error is a terminal; yields what to call with stage, done, total."""
    if is_quiet() or not sys.stderr.isatty():
        yield lambda _stage, _done, _total: None
        return
    with _terminal_progress() as progress:
        task = progress.add_task("", total=None)
        yield lambda stage, done, total: progress.update(task, description=stage, completed=done, total=total)


def _terminal_progress(bar: BarColumn | None = None) -> Progress:
    from rich.console import Console  # noqa: PLC0415 - only terminals need it
    from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn  # noqa: PLC0415

    text = TextColumn("{task.description:<10}", markup=False)
    columns = (SpinnerColumn(), text, bar or BarColumn(), TimeElapsedColumn())
    return Progress(*columns, console=Console(stderr=True), transient=True)
