"""Files that appear together or not at all.

Every file is written beside its target, in a hidden folder on the same file system, and renamed into place when all of
them are complete. Renaming is atomic, and signals wait until the last rename is done: whoever interrupts a run finds
the old files or the new ones, never half of one and never a mixture.
"""

from __future__ import annotations

import os
import shutil
import signal
import tempfile
import threading
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import FrameType

_INTERRUPTS = (signal.SIGINT, signal.SIGTERM)


class OutputError(Exception):
    """A file that cannot be written where the user wants it, in one line."""


def check_folder(folder: Path) -> None:
    """Refuse a folder that cannot be written to, before any work is done for it.

    Raises
    ------
    OutputError
        `folder` is a file, lies in one, or may not be written to.
    """
    nearest = folder
    while not nearest.exists() and nearest != nearest.parent:
        nearest = nearest.parent
    if not nearest.is_dir():
        raise OutputError(f"{folder}: {nearest} is a file, not a folder; name another folder")
    if not os.access(nearest, os.W_OK | os.X_OK):
        raise OutputError(f"{folder}: no permission to write in {nearest}; name another folder")


@contextmanager
def staged(targets: tuple[Path, ...]) -> Iterator[tuple[Path, ...]]:
    """Yield a path to write to for each target, under the target's own name; move all into place at the end.

    When the block raises, nothing is moved and nothing is left behind.

    Raises
    ------
    OutputError
        A target's folder cannot be made or written to, the target is a folder, or the disk is full.
    """
    folders: dict[Path, Path] = {}
    try:
        for target in targets:
            if target.is_dir():
                raise OutputError(f"{target}: is a folder; name a file")
            with _refusals(target), _uninterrupted():
                target.parent.mkdir(parents=True, exist_ok=True)
                if target.parent not in folders:
                    folders[target.parent] = Path(tempfile.mkdtemp(prefix=".voxrt-", dir=target.parent))
        stand_ins = tuple(folders[target.parent] / target.name for target in targets)
        with _refusals(targets[0]):
            yield stand_ins
        with _uninterrupted():
            for stand_in, target in zip(stand_ins, targets, strict=True):
                with _refusals(target):
                    stand_in.replace(target)
    finally:
        with _uninterrupted():
            for folder in folders.values():
                shutil.rmtree(folder, ignore_errors=True)


@contextmanager
def _refusals(target: Path) -> Iterator[None]:
    """Say of an error of the operating system which output it hit."""
    try:
        yield
    except OSError as error:
        raise OutputError(f"{target}: cannot be written: {error.strerror or error}; name another place") from error


@contextmanager
def _uninterrupted() -> Iterator[None]:
    """Hold back interrupts until the block is done, then let the last one through."""
    if threading.current_thread() is not threading.main_thread():  # signals never arrive elsewhere
        yield
        return
    held: list[int] = []

    def hold(number: int, _frame: FrameType | None) -> None:
        held.append(number)

    before = {number: signal.signal(number, hold) for number in _INTERRUPTS}
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        if held:
            signal.raise_signal(held[-1])
