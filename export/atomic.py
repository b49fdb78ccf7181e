"""Files that appear whole or not at all, alone or as a set. Every file that voxrt writes goes through here.

The bytes go to a new hidden file beside the target, ``.NAME.XXXXXXXX.tmp``, and reach the disk before that file takes
the target's name. Its writer keeps it locked, so a later writer of the same target knows the files of writers that were
killed, and removes them.
"""

from __future__ import annotations

import errno
import os
import re
import signal
import stat
import threading
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO

try:
    import fcntl
except ImportError:  # no POSIX system: files are replaced all the same, and nobody tells the dead from the living
    fcntl = None  # type: ignore[assignment]

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping
    from types import FrameType

INTERRUPTS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)

_STEM = 60
"""Characters of the target's name in that of the temporary file: whatever these are, the name is not too long."""


def write_atomically(path: Path, data: bytes | Iterable[bytes]) -> None:
    """Write `data` to `path` so that an interruption at any moment leaves the old file or the new.

    A file that is replaced keeps its mode. A link is followed. What is no regular file, such as a pipe, is written to
    as it is. After an OSError the old file is untouched and nothing new stays.
    """
    write_together({path: data})


def write_together(files: Mapping[Path, bytes | Iterable[bytes] | None]) -> None:
    """Write files that belong together: an error or an interruption leaves all of the old ones or all of the new.

    The bytes of a file may come in pieces. None in place of them removes a file that does not belong to the new set, or
    a link to one.

    They change places in their order. Sets whose first files stand in one folder change one after another, whoever
    writes them. A process that is killed in the microseconds between two renamings leaves the rest of the set under
    the temporary names, where :func:`staged_files` finds it. After an OSError all old files are untouched and nothing
    new stays.
    """
    targets = {path if data is None else _followed(path): data for path, data in files.items()}
    with ExitStack() as stack:
        if len(targets) > 1:
            stack.enter_context(_lock_folder(next(iter(targets)).parent))
        stack.enter_context(_uninterrupted())
        staged: dict[Path, Path | None] = {}
        for path, data in targets.items():
            if data is None:
                staged[path] = None
            elif _is_device(path):
                with path.open("wb") as device:
                    device.writelines(_pieces(data))
            else:
                staged[path] = _stage(path, data, stack)
        _rename(staged)
        for folder in {path.parent for path in targets}:
            sync_folder(folder)
        for path in targets:
            _remove_leftovers(path)


@contextmanager
def new_folder(folder: Path) -> Iterator[None]:
    """Make a folder and those above it; OSError where that fails. Remove what was made if the block fails."""
    missing = []
    while not folder.exists() and folder != folder.parent:
        missing.append(folder)
        folder = folder.parent
    made: list[Path] = []
    try:
        for new in reversed(missing):
            made.append(new)
            new.mkdir(exist_ok=True)  # somebody else may have made it by now
        yield
    except BaseException:
        for new in reversed(made):
            with suppress(OSError):  # not empty: somebody else uses it
                new.rmdir()
        raise


def staged_files(path: Path) -> list[Path]:
    """Find the temporary files of a target, whether their writers live or not."""
    pattern = re.compile(rf"\.{re.escape(path.name[:_STEM])}\.[0-9a-f]{{8}}\.tmp")
    try:
        with os.scandir(path.parent) as entries:
            return [path.with_name(entry.name) for entry in entries if pattern.fullmatch(entry.name)]
    except OSError:
        return []


def sync_folder(folder: Path) -> None:
    """Bring the names in `folder` to the disk, where the platform lets a folder be opened."""
    if not hasattr(os, "O_DIRECTORY"):
        return
    descriptor = os.open(folder, os.O_DIRECTORY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _followed(path: Path) -> Path:
    return Path(os.path.realpath(path)) if path.is_symlink() else path


def _is_device(path: Path) -> bool:
    """Tell whether a file is there that cannot be replaced: a pipe, a terminal, a null device."""
    try:
        return not stat.S_ISREG(mode := path.stat().st_mode) and not stat.S_ISDIR(mode)
    except FileNotFoundError:
        return False


def _pieces(data: bytes | Iterable[bytes]) -> Iterable[bytes]:
    return (data,) if isinstance(data, bytes) else data


def _stage(path: Path, data: bytes | Iterable[bytes], stack: ExitStack) -> Path:
    """Write to a new file beside the target; `stack` removes and closes it."""
    if path.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    temporary, file = _new_file(path)
    stack.callback(file.close)
    stack.callback(temporary.unlink, missing_ok=True)
    with suppress(FileNotFoundError):
        os.fchmod(file.fileno(), stat.S_IMODE(path.stat().st_mode))
    file.writelines(_pieces(data))
    file.flush()
    os.fsync(file.fileno())
    return temporary


def _new_file(path: Path) -> tuple[Path, BinaryIO]:
    """Open a new file under a name that nobody has, and lock it."""
    while True:
        temporary = _temporary(path)
        file = temporary.open("xb")
        if _lock(file.fileno(), wait=True) and not os.fstat(file.fileno()).st_nlink:
            file.close()  # another writer took it for a leftover before it was locked
            continue
        return temporary, file


def _temporary(path: Path) -> Path:
    return path.with_name(f".{path.name[:_STEM]}.{os.urandom(4).hex()}.tmp")


def _rename(staged: Mapping[Path, Path | None]) -> None:
    """Give each temporary file its target's name, and remove targets that have none; do all of it or nothing."""
    kept: dict[Path, Path] = {}
    done: list[Path] = []
    try:
        if len(staged) > 1:
            for path in staged:
                with suppress(OSError):  # there is no old file, or the file system has no links
                    kept_as = _temporary(path)
                    os.link(path, kept_as)
                    kept[path] = kept_as
        for path, temporary in staged.items():
            if temporary is None:
                path.unlink(missing_ok=True)
            else:
                temporary.replace(path)
            done.append(path)
    except BaseException:
        for path in reversed(done):
            if path in kept:
                kept.pop(path).replace(path)
            else:
                path.unlink(missing_ok=True)
        raise
    finally:
        for kept_as in kept.values():
            kept_as.unlink(missing_ok=True)


def _remove_leftovers(path: Path) -> None:
    """Remove the temporary files of writers that are no more."""
    for leftover in staged_files(path):
        with suppress(OSError):
            descriptor = os.open(leftover, os.O_RDONLY | os.O_NOFOLLOW)
            try:
                if _lock(descriptor, wait=False):
                    leftover.unlink()
            finally:
                os.close(descriptor)


@contextmanager
def _uninterrupted() -> Iterator[None]:
    """Hold back SIGINT, SIGTERM and SIGHUP until the block is done, then let the last one through.

    For the moments in which several files change places: who interrupts finds all of the old ones or all of the new.
    Signals that are ignored stay ignored.
    """
    if threading.current_thread() is not threading.main_thread():  # signals never arrive elsewhere
        yield
        return
    held: list[int] = []

    def hold(number: int, _frame: FrameType | None) -> None:
        held.append(number)

    before = {}
    for number in INTERRUPTS:
        if signal.getsignal(number) not in {None, signal.SIG_IGN}:
            before[number] = signal.signal(number, hold)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        if held:
            signal.raise_signal(held[-1])


@contextmanager
def _lock_folder(folder: Path) -> Iterator[None]:
    """Let one process at a time into the block; a file system without locks lets all in."""
    if fcntl is None:
        yield
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        _lock(descriptor, wait=True)
        yield
    finally:
        os.close(descriptor)


def _lock(descriptor: int, *, wait: bool) -> bool:
    """Lock an open file until it is closed; False if it is locked already, or cannot be."""
    if fcntl is None:
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | (0 if wait else fcntl.LOCK_NB))
    except OSError:
        return False
    return True
