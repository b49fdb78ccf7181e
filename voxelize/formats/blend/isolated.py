"""Loading Blender files, each in a process of its own that runs Blender.

Blender is large, and trusts its files (``reader_process``). It is the module ``bpy``, if that is installed, or else the
program ``blender``, whose Python must be of this version to import voxrt.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec.structs import replace

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.opacity import OPAQUE_FROM
from voxrt.voxelize.formats.reader_process.limits import Limits, Request
from voxrt.voxelize.formats.reader_process.parent import Reader, read_apart, reader_module, refuse_unopenable

if TYPE_CHECKING:
    from voxrt.voxelize.scene import Scene

_CHILD = "voxrt.voxelize.formats.blend.child"
_INSTALL = "pip install bpy, install Blender, or export the scene as glTF from Blender"
_BPY_MEMORY = 1 << 30  # bytes that Blender itself takes
_OUTPUT = 9  # the descriptor of the message of the program's child
_PYTHON = f"{sys.version_info[0]}.{sys.version_info[1]}"
_SHOWN = "voxrt-python="


def read_isolated(
    path: Path,
    *,
    time: float | None = None,
    allow_outside: bool = False,
    opaque_from: float = OPAQUE_FROM,
    limits: Limits | None = None,
) -> Scene:
    """Read a Blender file in a process of its own, within limits on its memory and its time.

    The scene is that which a render of the file's active scene and view layer shows. Scripts in the file are not run.

    Parameters
    ----------
    path
        A ``.blend`` file.
    time
        Seconds after the first frame of the scene; None for the frame at which the file was saved.
    allow_outside
        Whether libraries and images may stand outside the file's folder.
    opaque_from
        Faces of lower opacity are left out, unless their material rounds its alpha.
    limits
        What reading a small file may take; larger files may take more. None for the limits of this machine.

    Returns
    -------
    Scene
        One object per object and instance; the scene's camera first.

    Raises
    ------
    AssetError
        There is no Blender here; the file cannot be opened, names a library that is missing, shows nothing, exceeds the
        limits, or ends the process that reads it.
    DoesNotFitError
        More than 255 materials.
    """
    if limits is None:
        own = Limits.of_this_machine()
        limits = replace(own, memory=min(own.memory + _BPY_MEMORY, own.most_memory))
    refuse_unopenable("Blender", path)
    command, output = _command(path)
    request = Request(limits=limits, output=output, time=time, allow_outside=allow_outside, opaque_from=opaque_from)
    reader = Reader(
        "Blender",
        command,
        too_slow="repair it, or apply its modifiers in Blender",
        # The user's preferences, add-ons and startup file are not those of the file.
        folders=("TMPDIR", "BLENDER_USER_RESOURCES", "HOME"),
    )
    return read_apart(reader, path, request)


def _command(path: Path) -> tuple[tuple[str, ...], int]:
    """Return the program that runs the child, and where that writes its message; AssetError without Blender."""
    if find_spec("bpy") is not None:
        return reader_module(_CHILD), 1
    program = shutil.which("blender")
    if program is None:
        raise AssetError(path, "Blender, which reads it, is not here", fix=_INSTALL)
    return _program_command(path, program), _OUTPUT


def _program_command(path: Path, program: str) -> tuple[str, ...]:
    """Return how the program ``blender`` runs the child; AssetError where its Python cannot import voxrt."""
    quiet = (program, "--background", "--factory-startup", "--disable-autoexec", "--python-exit-code", "1")
    show = f"import sys; print('{_SHOWN}%d.%d' % sys.version_info[:2])"
    ran = subprocess.run([*quiet, "--python-expr", show], capture_output=True, text=True, check=False)  # noqa: S603
    found = next((one.removeprefix(_SHOWN) for one in ran.stdout.split() if one.startswith(_SHOWN)), "none")
    if found != _PYTHON:
        raise AssetError(path, f"{program} has Python {found}, and this voxrt is for {_PYTHON}", fix=_INSTALL)
    import voxrt  # noqa: PLC0415 - its place alone is of interest

    paths = [str(Path(voxrt.__file__).resolve().parent.parent), *(one for one in sys.path if "site-packages" in one)]
    run = f"import runpy, sys; sys.path.extend({paths!r}); runpy.run_module({_CHILD!r}, run_name='__main__')"
    # The program prints while it starts.
    return "/bin/sh", "-c", f'exec "$@" {_OUTPUT}>&1 1>&2', "sh", *quiet, "--python-expr", run, "--"
