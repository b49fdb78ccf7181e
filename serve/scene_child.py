"""What runs in the process that :mod:`~.scene_process` starts: it reads files, and writes the scene to its output.

The output is lines of JSON, each one of the three structs here: any number of :class:`Stage`, then a :class:`Problem`,
or a :class:`Described` and its arrays: colours (256, 3) uint8, mirrors (256,) uint8, words uint32, little-endian.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
from pathlib import Path
from typing import TYPE_CHECKING, BinaryIO, NoReturn, TypeAlias

import msgspec

from voxrt.board.errors import Refused
from voxrt.octree.camera import Camera, Lighting  # noqa: TC001 - msgspec resolves the annotations of this module
from voxrt.serve.shown_text import shown_line, shown_warnings

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from voxrt.board.scene import Scene
    from voxrt.board.scene_memory import Progress

_NICE = 10
_NAME = 100  # characters of a material's name


class Stage(msgspec.Struct, frozen=True, tag=True):
    """What :class:`~.scene_memory.Progress` receives."""

    stage: str
    done: int
    total: int


class Problem(msgspec.Struct, frozen=True, tag=True):
    """Why the files are no scene."""

    text: str


class Described(msgspec.Struct, frozen=True, tag=True):
    """A scene without its arrays; `words` counts them."""

    name: str
    depth: int
    words: int
    camera: Camera | None
    lighting: Lighting | None
    roots: tuple[int, ...]
    period: float | None
    warnings: tuple[str, ...]
    names: tuple[str, ...] = ()
    voxel_size: float | None = None


Message: TypeAlias = Stage | Problem | Described


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
        _write(out, Stage(stage, done, total))

    def refuse(problem: str) -> None:
        _write(out, Problem(shown_line(problem)))

    try:
        scene = read([Path(name) for name in files], progress)
    except Refused as refusal:
        refuse(str(refusal))
    except MemoryError:
        refuse("there is not enough memory for the scene; build it with a smaller depth")
    except OSError as error:
        name = f"{Path(os.fsdecode(error.filename)).name}: " if isinstance(error.filename, str | bytes) else ""
        refuse(f"{name}cannot be read: {error.strerror or error}")
    except Exception as error:  # noqa: BLE001 - whatever it is, the client gets an answer
        refuse(f"the files cannot be read: {type(error).__name__}: {error}; please report this")
    else:
        _write(
            out,
            Described(
                shown_line(scene.name),
                scene.depth,
                len(scene.words),
                scene.camera,
                scene.lighting,
                scene.roots,
                scene.period,
                shown_warnings(scene.warnings),
                tuple(shown_line(name, _NAME) for name in scene.names),
                scene.voxel_size,
            ),
        )
        for array, kind in ((scene.colours, "u1"), (scene.mirrors, "u1"), (scene.words, "<u4")):
            out.write(array.astype(kind).tobytes())
        out.flush()
    os._exit(0)  # without the interpreter's end, which takes long after a large build


def _write(out: BinaryIO, message: Message) -> None:
    out.write(msgspec.json.encode(message) + b"\n")
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
