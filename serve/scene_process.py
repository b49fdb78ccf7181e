"""Scenes from files, made by a process of its own, which can be ended at any time.

The files may come from strangers. What goes wrong while they are read, a crash included, ends that process alone.
:mod:`~.scene_child` is the other side.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import sys
import tempfile
from typing import TYPE_CHECKING, Protocol

import msgspec
import numpy as np

from voxrt.board.errors import Refused
from voxrt.board.scene import Scene
from voxrt.serve.scene_child import Described, Message, Problem, Stage
from voxrt.serve.shown_text import shown_line, shown_warnings
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from voxrt.board.scene_memory import Progress

READ_SECONDS = 600.0
"""The longest time that the files of a scene may take."""

WORDS_LIMIT = 1 << 26
"""Words of the largest scene."""

_LINE_LIMIT = 1 << 18  # the roots of 4096 frames among it
_END_SECONDS = 5.0  # that a killed process may take to end, or one that has closed its output
_COLOURS, _MIRRORS = 3 * 256, 256


class SceneReader(Protocol):
    """Makes scenes from uploaded files."""

    @property
    def suffixes(self) -> tuple[str, ...]:
        """Suffixes of the files that hold a scene, such as ``.mem``."""

    async def read(self, paths: Sequence[Path], progress: Progress) -> Scene:
        """Make a scene from files; a caller that is cancelled ends it.

        Raises
        ------
        Refused
            The files are no scene.
        """


class ChildReader(Value, frozen=True):
    """Makes scenes in a process of its own.

    Attributes
    ----------
    suffixes
        Suffixes of the files that hold a scene.
    arguments
        Arguments of Python: a module that calls :func:`~.scene_child.run_child`, with its options. The paths of the
        files follow.
    seconds
        Time limit.
    """

    suffixes: tuple[str, ...]
    arguments: tuple[str, ...]
    seconds: float = READ_SECONDS

    async def read(self, paths: Sequence[Path], progress: Progress) -> Scene:
        """Make a scene from files; a caller that is cancelled ends the process, and nothing of it stays.

        Raises
        ------
        Refused
            The files are no scene, or take too long, or the process died.
        """
        try:
            with tempfile.TemporaryDirectory(prefix="voxrt-scene-") as scratch:
                return await asyncio.wait_for(self._read(paths, progress, scratch), self.seconds)
        except TimeoutError:
            raise Refused(
                f"the scene takes more than {self.seconds:.0f} s to build; build it before: voxrt build"
            ) from None
        except OSError as error:
            raise Refused(f"the server cannot read the files: {error.strerror or error}") from error

    async def _read(self, paths: Sequence[Path], progress: Progress, scratch: str) -> Scene:
        # The child is alone in its process group, so that its own children end with it. Uploaded files are never
        # imported: PYTHONSAFEPATH leaves the folder of the caller out of the path.
        process = await asyncio.create_subprocess_exec(
            sys.executable,
            *self.arguments,
            *map(str, paths),
            stdin=asyncio.subprocess.PIPE,  # its end tells the child that this process is gone
            stdout=asyncio.subprocess.PIPE,
            stderr=asyncio.subprocess.DEVNULL,
            limit=_LINE_LIMIT,
            start_new_session=True,
            env={**os.environ, "TMPDIR": scratch, "PYTHONSAFEPATH": "1"},
        )
        try:
            return await _receive(process, progress)
        finally:
            await _end(process)


async def _end(process: asyncio.subprocess.Process) -> None:
    """Kill a process and its children, and wait for their end, but not for ever."""
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    with contextlib.suppress(TimeoutError):
        async with asyncio.timeout(_END_SECONDS):
            assert process.stdout is not None
            while await process.stdout.read(1 << 20):  # asyncio waits until the pipe is empty, too
                pass
            await process.wait()


async def _receive(process: asyncio.subprocess.Process, progress: Progress) -> Scene:
    out = process.stdout
    assert out is not None
    try:
        while True:
            match msgspec.json.decode(await out.readuntil(), type=Message):
                case Stage(stage, done, total):
                    progress(stage, done, total)
                case Problem(text):
                    raise Refused(shown_line(text))
                case described:
                    return await _receive_scene(out, described)
    except asyncio.IncompleteReadError:
        how = await _how_it_ended(process)
    except (asyncio.LimitOverrunError, msgspec.MsgspecError):
        how = "it sent what is no scene"
    raise Refused(
        f"the process that read the files died ({how}): a file is damaged, or needs more memory than there is"
    )


async def _how_it_ended(process: asyncio.subprocess.Process) -> str:
    """Say how a process ended that has closed its output."""
    try:
        code = await asyncio.wait_for(process.wait(), _END_SECONDS)
    except TimeoutError:
        return "it closed its output and went on"
    return signal.Signals(-code).name if code < 0 else f"exit code {code}"


async def _receive_scene(out: asyncio.StreamReader, described: Described) -> Scene:
    count = described.words
    if not 1 <= count <= WORDS_LIMIT:
        raise Refused(f"the scene has {count} words, which is more than {WORDS_LIMIT}; build it with a smaller depth")
    colours = np.frombuffer(await out.readexactly(_COLOURS), dtype=np.uint8).reshape(256, 3)
    mirrors = np.frombuffer(await out.readexactly(_MIRRORS), dtype=np.uint8) != 0
    data = bytearray(4 * count)
    at = 0
    while at < len(data):
        part = await out.read(1 << 20)
        if not 1 <= len(part) <= len(data) - at:
            raise asyncio.IncompleteReadError(part, len(data) - at)
        data[at : at + len(part)] = part
        at += len(part)
    words = np.frombuffer(data, dtype="<u4").astype(np.uint32, copy=False)
    name, camera, lighting = shown_line(described.name), described.camera, described.lighting
    roots, period, warnings = described.roots, described.period, shown_warnings(described.warnings)
    names = tuple(shown_line(one) for one in described.names[:256])
    return Scene(
        name,
        described.depth,
        words,
        colours,
        mirrors,
        camera,
        lighting,
        roots,
        period,
        warnings,
        names,
        described.voxel_size,
    )
