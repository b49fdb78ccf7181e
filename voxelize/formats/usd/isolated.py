"""Loading USD files, each in a process of its own.

usd-core is a large C++ library that trusts its files: one wrong byte can end the process, and a few kilobytes can take
all memory. A fresh interpreter therefore reads the file within limits (``limits.py``) and sends the scene as plain
arrays; this process never imports usd-core. A fork would be faster by the start of an interpreter, but a process with
threads must not fork. It costs about a tenth of a second.
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

from voxrt.voxelize.errors import AssetError, DoesNotFitError
from voxrt.voxelize.formats.external_files import LFS_POINTER, refuse_pointer
from voxrt.voxelize.formats.opacity import OPAQUE_FROM
from voxrt.voxelize.formats.scene_message import (
    LENGTHS,
    AssetErrorMessage,
    BadMessageError,
    DoesNotFitMessage,
    FaultMessage,
    MemoryMessage,
    read_message,
)
from voxrt.voxelize.formats.usd.limits import Limits, Request
from voxrt.voxelize.scene import Scene

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.voxelize.formats.scene_message import Failure

_CHILD = "voxrt.voxelize.formats.usd.child"
# Each thread takes memory of its own, whatever it does.
_ENVIRONMENT = {"PXR_WORK_THREAD_LIMIT": "4", "MALLOC_ARENA_MAX": "2", "OPENBLAS_NUM_THREADS": "1"}
_END_SECONDS = 5.0  # that a process may take to end when its message has ended
_SEARCH_PATH = "PXR_AR_DEFAULT_SEARCH_PATH"  # folders in which usd-core looks for layers
_REPAIR = "it is damaged, or made to do harm: repair it or export it again"


def read_isolated(
    path: Path,
    *,
    variants: Sequence[str] = (),
    time: float | None = None,
    allow_outside: bool = False,
    opaque_from: float = OPAQUE_FROM,
    limits: Limits | None = None,
) -> Scene:
    """Read a USD stage in a process of its own, within limits on its memory and its time.

    The scene shows the active, visible prims of purpose ``default`` and ``render``, with instances, the copies of point
    instancers, and skinned meshes in their pose. The unit and the up axis are the root layer's, as in USD: layers that
    it refers to are not rescaled, and counted where they disagree.

    Parameters
    ----------
    path
        A ``.usd``, ``.usda``, ``.usdc`` or ``.usdz`` file.
    variants
        Variants to select, in this order: ``"/prim/path:set=name"``.
    time
        Seconds after the stage's start; None for the start.
    allow_outside
        Whether layers and textures may stand outside the file's folder.
    opaque_from
        Faces of lower opacity are left out, unless their material has an opacity threshold of its own.
    limits
        What reading a small file may take; larger files may take more. None for the limits of this machine.

    Returns
    -------
    Scene
        One object per prim and copy, named by its prim path; materials in order of first use; the stage's cameras.

    Raises
    ------
    AssetError
        The stage cannot be opened, contradicts itself, shows nothing, exceeds the limits, or ends the process that
        reads it.
    DoesNotFitError
        More than 255 materials or a million objects.
    """
    _refuse_unopenable(path)
    limits = Limits.of_this_machine() if limits is None else limits
    request = Request(
        parent=os.getpid(),
        variants=tuple(variants),
        time=time,
        allow_outside=allow_outside,
        opaque_from=opaque_from,
        memory=limits.memory,
        most_memory=limits.most_memory,
        seconds=limits.seconds,
    )
    environment = os.environ | _ENVIRONMENT
    if not allow_outside:
        environment.pop(_SEARCH_PATH, None)
    # usd-core leaves notes about its crashes in the temporary folder: it gets one that is removed.
    with tempfile.TemporaryDirectory(prefix="voxrt-usd-") as folder, tempfile.TemporaryFile() as printed:
        child = subprocess.Popen(  # noqa: S603 - our own module; the file's name is one argument
            # -P: the folder that the user works in may hold a hostile numpy.py.
            [sys.executable, "-P", "-m", _CHILD, path.absolute(), msgspec.json.encode(request)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=printed,
            env=environment | {"TMPDIR": folder},
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
            raise _ended(path, status, _tail(printed), limits)
    try:
        found = read_message(*message)
    except BadMessageError as error:
        raise AssetError(path, f"usd-core read nonsense from it ({error})", fix=_REPAIR) from None
    if isinstance(found, Scene):
        return found
    raise _error(path, found, limits)


def _refuse_unopenable(path: Path) -> None:
    try:
        str(path).encode()
    except UnicodeEncodeError:
        raise AssetError(path, "its path is not UTF-8, and usd-core opens no such file", fix="rename it") from None
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


def _ended(path: Path, status: int, printed: bytes, limits: Limits) -> AssetError:
    """Return the error for a process that ended without a message, by its exit status and what it printed."""
    if -status in {signal.SIGXCPU, signal.SIGALRM}:
        problem = f"takes more than {limits.seconds:g} seconds to read, which is too long for a file of its size"
        return AssetError(path, problem, fix="it is damaged, or made to do harm: repair it, or flatten it with usdcat")
    if b"bad_alloc" in printed or b"MemoryError" in printed:
        return _too_much_memory(path, limits)
    how = signal.Signals(-status).name if -status in set(signal.Signals) else f"exit status {status}"
    return AssetError(path, f"usd-core crashed while it read the file ({how})", fix=_REPAIR)


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
