"""The start and the end of the process: what must hold before the commands are imported, and after they have run.

Ctrl-C while modules are imported ends the process at once, with the exit code of an interrupted command and without a
traceback. Standard streams that the caller closed are opened again, so that no file of ours takes their numbers.
"""

from __future__ import annotations

import atexit
import gc
import os
import signal
import sys

TYPE_CHECKING = False  # typing is slow to import
if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from types import FrameType
    from typing import NoReturn

_VERSION_FLAGS = (["--version"], ["-V"])
_INTERRUPTED = 128 + signal.SIGINT


def start(arguments: Sequence[str]) -> NoReturn:
    """Run a command line and exit."""
    if "voxrt.exports" not in sys.modules:
        _refuse_other_package()
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, _leave)
    # The matrices of a build are small: OpenBLAS's threads would cost a short build a tenth of its time.
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    gc.disable()  # until the command is imported: imports make many objects and leave none
    _open_closed_streams()
    if arguments[-1:] in _VERSION_FLAGS and arguments[:-1] in ([], ["build"]):
        _print_version()
    from voxrt.cli.run import run  # noqa: PLC0415 - slow, and may be interrupted

    try:
        code = int(run(arguments))
    except KeyboardInterrupt:  # once more, while the first was reported
        code = _INTERRUPTED
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(code)


def end_at_once(command: Callable[[], None]) -> NoReturn:
    """Run a command that exits, and leave its memory to the system: to free every object takes 7 ms.

    Threads that are to be waited for, profilers and debuggers need the way that Python takes.
    """
    try:
        command()
    except SystemExit as end:
        threading = sys.modules.get("threading")
        has_threads = threading is not None and threading.active_count() > 1
        if not isinstance(end.code, int) or has_threads or sys.getprofile() is not None or sys.gettrace() is not None:
            raise
        atexit._run_exitfuncs()  # noqa: SLF001 - there is no public name
        try:
            sys.stdout.flush()
            sys.stderr.flush()
        except OSError:  # Python says it
            sys.exit(end.code)
        os._exit(end.code)
    sys.exit(0)


def _print_version() -> None:
    """Print the version and exit, without all that other commands need; return if it cannot be printed."""
    from voxrt import __version__  # noqa: PLC0415 - may be interrupted

    try:
        sys.stdout.write(f"{__version__}\n")
        sys.stdout.flush()
    except OSError:  # what runs commands says why
        return
    sys.exit(0)


def _refuse_other_package() -> NoReturn:
    """Exit with an error: another project's package of the name has replaced ours, all but the commands."""
    place = os.path.dirname(sys.modules["voxrt"].__file__ or "")  # noqa: PTH120 - pathlib is slow to import
    sys.exit(
        f"voxrt: error: the package voxrt in {place} is that of another project, which PyPI has under this name; "
        "remove both (pip uninstall voxrt voxrt-build) and install voxrt-build from its checkout"
    )


def _leave(_number: int, _frame: FrameType | None) -> NoReturn:
    os.write(2, b"voxrt: error: interrupted: every file is as it was, or complete\n")
    os._exit(_INTERRUPTED)


def _open_closed_streams() -> None:
    """Put the null device in place of closed streams; standard output only says that it cannot be written to."""
    for number, flags in ((0, os.O_RDONLY), (1, os.O_RDONLY), (2, os.O_WRONLY)):
        try:
            os.fstat(number)
        except OSError:
            os.open(os.devnull, flags)  # takes the lowest number that is free
    sys.stdin = sys.stdin or open(0, encoding="utf-8", closefd=False)  # noqa: SIM115 - they stay open
    sys.stdout = sys.stdout or open(1, "w", encoding="utf-8", closefd=False)  # noqa: SIM115
    sys.stderr = sys.stderr or open(2, "w", encoding="utf-8", closefd=False)  # noqa: SIM115
