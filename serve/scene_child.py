"""What runs in the process that :mod:`~.scene_process` starts: it reads files, and writes the scene to its output.

The output is lines of JSON: ``{"progress": [stage, done, total]}`` any number of times, then ``{"problem": text}``, or
``{"scene": {...}}`` and its arrays: colours (256, 3) uint8, mirrors (256,) uint8, words uint32, little-endian.
"""

from __future__ import annotations

import contextlib
import json
import os
import signal
import sys
import threading
from dataclasses import asdict, astuple
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, NoReturn

from voxrt.board.errors import Refused

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from voxrt.board.scene import Scene
    from voxrt.board.scene_memory import Progress

_NICE = 10


def run_child(read: Callable[[Sequence[Path], Progress], Scene], files: Sequence[str]) -> NoReturn:
    """Read files, write their scene or the problem to the output, and exit.

    Parameters
    ----------
    read
        Makes the scene. :class:`~.errors.Refused` says what is wrong with the files.
    files
        Their paths.
    """
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)  # libraries may print
    threading.Thread(target=_end_with_parent, daemon=True).start()
    _be_modest()

    def progress(stage: str, done: int, total: int) -> None:
        _write(out, {"progress": [stage, done, total]})

    try:
        scene = read([Path(name) for name in files], progress)
    except Refused as refusal:
        _write(out, {"problem": str(refusal)})
    except MemoryError:
        _write(out, {"problem": "there is not enough memory for the scene; build it with a smaller depth"})
    except OSError as error:
        name = f"{Path(os.fsdecode(error.filename)).name}: " if isinstance(error.filename, str | bytes) else ""
        _write(out, {"problem": f"{name}cannot be read: {error.strerror or error}"})
    except Exception as error:  # noqa: BLE001 - whatever it is, the client gets an answer
        _write(out, {"problem": f"the files cannot be read: {type(error).__name__}: {error}; please report this"})
    else:
        described = {"name": scene.name, "depth": scene.depth, "words": len(scene.words)}
        described |= {"roots": scene.roots, "period": scene.period}
        camera = None if scene.camera is None else astuple(scene.camera)
        lighting = None if scene.lighting is None else asdict(scene.lighting)
        _write(out, {"scene": {**described, "camera": camera, "lighting": lighting}})
        for array, kind in ((scene.colours, "u1"), (scene.mirrors, "u1"), (scene.words, "<u4")):
            out.write(array.astype(kind).tobytes())
        out.flush()
    os._exit(0)  # without the interpreter's end, which takes long after a large build


def _write(out: BinaryIO, message: dict[str, Any]) -> None:
    out.write(json.dumps(message).encode() + b"\n")
    out.flush()


def _end_with_parent() -> None:
    """End this process and its children when the server is gone: its end of the standard input is closed then."""
    sys.stdin.buffer.read()
    os.killpg(0, signal.SIGKILL)


def _be_modest() -> None:
    """Take less of the processor than the server, and at most half of the memory."""
    with contextlib.suppress(OSError):
        os.nice(_NICE)
    with contextlib.suppress(OSError):  # where memory runs out, Linux ends this process first
        Path("/proc/self/oom_score_adj").write_text("1000", encoding="ascii")
    with contextlib.suppress(ImportError, OSError, ValueError):
        import resource  # noqa: PLC0415 - Windows has none

        half = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // 2
        _, most = resource.getrlimit(resource.RLIMIT_DATA)
        resource.setrlimit(resource.RLIMIT_DATA, (half, most))
