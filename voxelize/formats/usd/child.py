"""The process that reads one USD file: ``python -m voxrt.voxelize.formats.usd.child PATH REQUEST``.

REQUEST is JSON of :class:`Request`. Unless it allows files outside of PATH's folder, the kernel refuses to open them,
whatever the stage asks for. The scene, or why there is none, goes to the standard output as
:mod:`voxrt.voxelize.formats.scene_message` says. Whatever usd-core does to this process, the one that started it goes
on.
"""

from __future__ import annotations

import ctypes
import os
import signal
import sys
import tempfile
import traceback
from pathlib import Path

import msgspec

from voxrt.voxelize.errors import AssetError, DoesNotFitError
from voxrt.voxelize.file_sandbox import confine
from voxrt.voxelize.formats.scene_message import (
    AssetErrorMessage,
    DoesNotFitMessage,
    FaultMessage,
    MemoryMessage,
    failure_bytes,
    scene_bytes,
)
from voxrt.voxelize.formats.usd.limits import Allowance, Limits, Request

_PR_SET_PDEATHSIG = 1


def main() -> None:
    """Read the file that the arguments name."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the parent decides
    path, request = Path(sys.argv[1]), msgspec.json.decode(sys.argv[2], type=Request)
    _end_with(request.parent)
    os.chdir(path.parent)  # usd-core looks here for layers whose names begin without a dot
    output = os.dup(1)
    os.dup2(2, 1)  # what libraries print is no part of the message
    for part in _reply(path, request):
        _write(output, part)
    # What libraries do at the end of a process, after reading a damaged file, is of no interest.
    os._exit(0)


def _reply(path: Path, request: Request) -> list[bytes | memoryview]:
    try:
        if not request.allow_outside:
            confine((path, path.parent), (Path(tempfile.gettempdir()),))
        allowance = Allowance(Limits(request.memory, request.most_memory, request.seconds))
        from voxrt.voxelize.formats.usd.stage_scene import read_stage  # noqa: PLC0415 - within the limits

        scene = read_stage(
            path,
            allowance,
            variants=request.variants,
            time=request.time,
            allow_outside=request.allow_outside,
            opaque_from=request.opaque_from,
        )
        return scene_bytes(scene)
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


if __name__ == "__main__":
    main()
