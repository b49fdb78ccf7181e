"""Reading a file in a process of its own, so that whatever a library does with it, this process goes on.

A large library that trusts its files can be ended by one wrong byte, and a few kilobytes can take all memory. A fresh
interpreter therefore reads the file within limits (``limits.py``) and sends the scene as plain arrays; this process
never imports the library. A fork would be faster by the start of an interpreter, but a process with threads must not
fork.
"""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import tempfile
from typing import IO, TYPE_CHECKING

import msgspec
import numpy as np
from msgspec import Struct, field

from voxrt.voxelize.errors import AssetError, DoesNotFitError
from voxrt.voxelize.formats.external_files import LFS_POINTER, refuse_pointer
from voxrt.voxelize.formats.scene_message import (
    LENGTHS,
    AssetErrorMessage,
    BadMessageError,
    DoesNotFitMessage,
    FaultMessage,
    MemoryMessage,
    read_message,
)
from voxrt.voxelize.scene import Scene

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.voxelize.formats.reader_process.limits import Limits, Request
    from voxrt.voxelize.formats.scene_message import Failure

# Each thread takes memory of its own, whatever it does.
_ENVIRONMENT = {"MALLOC_ARENA_MAX": "2", "OPENBLAS_NUM_THREADS": "1"}
_NO_MEMORY = (b"bad_alloc", b"MemoryError", b"alloc returns null")  # of C++, Python and Blender
_END_SECONDS = 5.0  # that a process may take to end when its message has ended
_REPAIR = "it is damaged, or made to do harm: repair it or export it again"


class Reader(Struct, frozen=True):
    """A program that reads files by a library: it is called with the file and the request, and prints a message."""

    library: str  # what errors call it
    command: tuple[str, ...]  # the program and its first arguments
    too_slow: str  # what to do about a file that takes too long
    environment: Mapping[str, str] = field(default_factory=dict)  # what it adds to that of this process
    folders: tuple[str, ...] = ("TMPDIR",)  # variables that name the folder in which it may write
    removed: tuple[str, ...] = ()  # variables that it does not get


def reader_module(name: str) -> tuple[str, ...]:
    """Return the command of a reader that is a module of ours."""
    # -P: the folder that the user works in may hold a hostile numpy.py.
    return sys.executable, "-P", "-m", name


def read_apart(reader: Reader, path: Path, request: Request) -> Scene:
    """Read a file in a process of its own. AssetError or DoesNotFitError where there is no scene."""
    limits = request.limits
    refuse_unopenable(reader.library, path)
    kept = {name: value for name, value in os.environ.items() if name not in reader.removed}
    # Libraries leave notes about their crashes in the temporary folder: it gets one that is removed.
    with tempfile.TemporaryDirectory(prefix="voxrt-") as folder, tempfile.TemporaryFile() as printed:
        child = subprocess.Popen(  # noqa: S603 - our own module; the file's name is one argument
            [*reader.command, path.absolute(), msgspec.json.encode(request)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=printed,
            env=kept | _ENVIRONMENT | dict(reader.environment) | dict.fromkeys(reader.folders, folder),
        )
        assert child.stdout is not None
        try:
            message = _receive(child.stdout, limits.most_memory)
            status = _end(child) if message is None else 0
        finally:  # Ctrl-C among others
            child.stdout.close()
            child.kill()
            child.wait()
        if message is None:
            raise _ended(reader, path, status, _tail(printed), limits)
    try:
        found = read_message(*message)
    except BadMessageError as error:
        raise AssetError(path, f"{reader.library} read nonsense from it ({error})", fix=_REPAIR) from None
    if isinstance(found, Scene):
        return found
    raise _error(path, found, limits)


def refuse_unopenable(library: str, path: Path) -> None:
    """Raise AssetError for a file that cannot be read, and for one that stands for another."""
    try:
        str(path).encode()
    except UnicodeEncodeError:
        problem = f"its path is not UTF-8, and {library} opens no such file"
        raise AssetError(path, problem, fix="rename it") from None
    try:
        with path.open("rb") as file:
            refuse_pointer(path, file.read(len(LFS_POINTER)))
    except OSError as error:
        raise AssetError(path, f"cannot be read: {error.strerror}", fix="check the path and its permissions") from None


def _receive(pipe: IO[bytes], most: int) -> tuple[bytes, NDArray[np.uint8]] | None:
    """Return the two parts of a message; None where it ends early or claims more than `most` bytes."""
    head = pipe.read(LENGTHS.size)
    if len(head) < LENGTHS.size:
        return None
    of_text, of_arrays = LENGTHS.unpack(head)
    if of_text + of_arrays > most:
        return None
    text = pipe.read(of_text)
    arrays = np.empty(of_arrays, np.uint8)
    view, filled = arrays.data, 0
    while filled < of_arrays:
        count = pipe.readinto(view[filled:])  # type: ignore[attr-defined]
        if not count:
            return None
        filled += count
    return text, arrays


def _end(child: subprocess.Popen[bytes]) -> int:
    """Return the exit status of a process whose message is not whole; what does not end soon is killed."""
    assert child.stdout is not None
    child.stdout.close()  # so that it does not wait for a reader
    try:
        return child.wait(_END_SECONDS)
    except subprocess.TimeoutExpired:
        child.kill()
        return child.wait()


def _tail(printed: IO[bytes]) -> bytes:
    """Return the last of what a process printed."""
    printed.seek(max(printed.seek(0, os.SEEK_END) - 4096, 0))
    return printed.read()


def _ended(reader: Reader, path: Path, status: int, printed: bytes, limits: Limits) -> AssetError:
    """Return the error for a process that ended without a message, by its exit status and what it printed."""
    if -status in {signal.SIGXCPU, signal.SIGALRM}:
        problem = f"takes more than {limits.seconds:g} seconds to read, which is too long for a file of its size"
        return AssetError(path, problem, fix=f"it is damaged, or made to do harm: {reader.too_slow}")
    if any(words in printed for words in _NO_MEMORY):
        return _too_much_memory(path, limits)
    how = signal.Signals(-status).name if -status in set(signal.Signals) else f"exit status {status}"
    return AssetError(path, f"{reader.library} crashed while it read the file ({how})", fix=_REPAIR)


def _too_much_memory(path: Path, limits: Limits) -> AssetError:
    allowed = f"{limits.memory / 2**30:.1f} GiB"
    problem = f"needs more memory than a file of its size may take ({allowed} for a small file)"
    return AssetError(path, problem, fix="it is damaged, or made to do harm: repair it, split it, or free memory")


def _error(path: Path, failure: Failure, limits: Limits) -> Exception:
    match failure:
        case AssetErrorMessage(problem, place, fix):
            return AssetError(path, problem, place=place, fix=fix)
        case DoesNotFitMessage(problem):
            return DoesNotFitError(problem)
        case MemoryMessage():
            return _too_much_memory(path, limits)
        case FaultMessage(error, traceback):
            unexpected = RuntimeError(f"{path}: {error}")
            unexpected.add_note(traceback)
            return unexpected
