"""What the commands say to people, on standard error."""

from __future__ import annotations

import os
import sys
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator
    from pathlib import Path

    from voxrt.sim import CacheCost, Frame
    from voxrt.voxelize import SceneWarning

_SHOWN_OF_A_KIND = 3


def printable(text: object) -> str:
    """Make one line of a text, with what a terminal would act on, and what is no text at all, spelled out."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in str(text))


def complain(problem: str) -> None:
    """Print an error, one line."""
    _print(f"voxrt: error: {printable(problem)}")


def warn(warnings: Iterable[SceneWarning]) -> None:
    """Print warnings, a line each, the first few of a kind; the manifest has them all."""
    kinds: dict[str, list[SceneWarning]] = {}
    for warning in warnings:
        kinds.setdefault(warning.kind, []).append(warning)
    for kind, alike in kinds.items():
        for warning in alike[:_SHOWN_OF_A_KIND]:
            times = f" ({warning.count} times)" if warning.count > 1 else ""
            _print(f"voxrt: warning: {printable(warning.message)}{times}")
        if len(alike) > _SHOWN_OF_A_KIND:
            _print(f"voxrt: warning: ... and {len(alike) - _SHOWN_OF_A_KIND} more of the kind {kind!r}")


def summarize(title: str, rows: Iterable[tuple[str, str]]) -> None:
    """Print a result for people: a title and aligned rows of a name and a value."""
    _print(printable(title))
    for name, value in rows:
        _print(f"  {name:<10} {printable(value)}")


def tabulate(heads: tuple[str, ...], rows: list[tuple[str, ...]]) -> None:
    """Print a table, numbers to the right."""
    rows = [tuple(map(printable, row)) for row in rows]
    widths = [max(len(row[column]) for row in [heads, *rows]) for column in range(len(heads))]
    right = [
        all(row[column].replace(",", "").replace(".", "").isdigit() for row in rows) for column in range(len(heads))
    ]
    for row in [heads, *rows]:
        cells = zip(row, widths, right, strict=True)
        _print(
            "  " + "  ".join(cell.rjust(wide) if number else cell.ljust(wide) for cell, wide, number in cells).rstrip()
        )


def picture_cost(frame: Frame, engine: str) -> str:
    """Return the cost of a picture in one line."""
    height, width = frame.material.shape
    cost = frame.cost
    cycles = "" if cost.cycles is None else f"{cost.cycles / cost.rays:.2f} cycles per pixel, "
    words = "" if cost.words_read is None else f"{cost.words_read / cost.rays:.2f} words per ray, "
    return f"{width}x{height} by {engine}: {cycles}{words}{cost.seconds:.2f} s"


def cache_cost(cost: CacheCost, pixels: int) -> str:
    """Return what a picture cost at the caches, in one line."""
    return (
        f"L1 hits {100 * cost.l1_hits:.1f} %, L2 hits {100 * cost.l2_hits:.1f} %, {cost.lines_read / pixels:.3f} lines and "
        f"{cost.bytes_read / pixels:.1f} bytes per pixel"
    )


def name_file(path: Path) -> str:
    """Give a file's name as text, for JSON; bytes of the name that are no text are spelled out."""
    return os.fsencode(path).decode("utf-8", "backslashreplace")


@contextmanager
def stage_bar(stages: int) -> Iterator[Callable[[str], None]]:
    """Show which stage a build is in, while standard error is a terminal; yields what to call at each one's begin."""
    if not sys.stderr.isatty():
        yield lambda _stage: None
        return
    from rich.console import Console  # noqa: PLC0415 - only terminals need it
    from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn  # noqa: PLC0415

    columns = (SpinnerColumn(), TextColumn("{task.description:<10}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("", total=stages)
        begun = 0

        def begin(stage: str) -> None:
            nonlocal begun
            progress.update(task, description=stage, completed=begun)
            begun += 1

        yield begin


@contextmanager
def transfer_bar() -> Iterator[Callable[[str, int, int], None]]:
    """Show how far a transfer is, while standard error is a terminal; yields what to call with stage, done, total."""
    if not sys.stderr.isatty():
        yield lambda _stage, _done, _total: None
        return
    from rich.console import Console  # noqa: PLC0415 - only terminals need it
    from rich.progress import BarColumn, Progress, SpinnerColumn, TextColumn, TimeElapsedColumn  # noqa: PLC0415

    columns = (SpinnerColumn(), TextColumn("{task.description:<10}"), BarColumn(), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as progress:
        task = progress.add_task("", total=None)
        yield lambda stage, done, total: progress.update(task, description=stage, completed=done, total=total)


def _print(line: str) -> None:
    print(line, file=sys.stderr)  # noqa: T201 - the one place that does
