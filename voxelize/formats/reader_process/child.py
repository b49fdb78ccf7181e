"""The process that reads one file: it is called with the file's path and a request, JSON.

Unless the request allows files outside of the file's folder, the kernel refuses to open them, whatever the file asks
for. The scene, or why there is none, goes to the standard output as :mod:`voxrt.voxelize.formats.scene_message` says.
Whatever a library does to this process, the one that started it goes on.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import tempfile
import traceback
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn, TypeVar

import msgspec

from voxrt.voxelize.errors import AssetError, DoesNotFitError
from voxrt.voxelize.file_sandbox import confine
from voxrt.voxelize.formats.reader_process.limits import Allowance, Request
from voxrt.voxelize.formats.scene_message import (
    AssetErrorMessage,
    DoesNotFitMessage,
    FaultMessage,
    MemoryMessage,
    failure_bytes,
    scene_bytes,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from voxrt.voxelize.scene import Scene

R = TypeVar("R", bound=Request)

_PR_SET_PDEATHSIG = 1


def serve_reader(kind: type[R], read: Callable[[Path, R, Allowance], Scene]) -> NoReturn:
    """Read the file that the last two arguments of this process name, send the scene, and end the process.

    `kind` is the request's class. `read` imports its library itself, so that the limits hold for the import.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent decides
    path, request = Path(sys.argv[-2]), msgspec.json.decode(sys.argv[-1], type=kind)
    _end_with(request.parent)
    os.chdir(path.parent)  # libraries look here for files whose names begin without a dot
    output = os.dup(request.output)
    os.dup2(2, 1)  # what libraries print is no part of the message
    for part in _reply(path, request, read):
        _write(output, part)
    # What libraries do at the end of a process, after reading a damaged file, is of no interest.
    os._exit(0)


def _reply(path: Path, request: R, read: Callable[[Path, R, Allowance], Scene]) -> list[bytes | memoryview]:
    try:
        if not request.allow_outside:
            confine((path, path.parent), (Path(tempfile.gettempdir()),))
        return scene_bytes(read(path, request, Allowance(request.limits)))
    except AssetError as error:
        return [*failure_bytes(AssetErrorMessage(error.problem, error.place, error.fix))]
    except DoesNotFitError as error:
        return [*failure_bytes(DoesNotFitMessage(str(error)))]
    except MemoryError:
        return [*failure_bytes(MemoryMessage())]
    except Exception as error:  # noqa: BLE001 - the parent raises it
        return [*failure_bytes(FaultMessage(f"{type(error).__name__}: {error}", traceback.format_exc()))]


def _write(output: int, part: bytes | memoryview) -> None:
    left = memoryview(part)
    while left:
        left = left[os.write(output, left) :]


def _end_with(parent: int) -> None:
    """End this process when its parent ends, where the system can (Linux)."""
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)
    if os.getppid() != parent:
        os._exit(1)
