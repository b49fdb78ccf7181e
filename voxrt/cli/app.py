"""The command line as a whole: which commands there are, what ends them, and what the exit code says."""

from __future__ import annotations

import os
import platform
import signal
import sys
import threading
import traceback
from enum import IntEnum
from typing import TYPE_CHECKING, NoReturn

import cyclopts

import voxrt
from voxrt.cli.arguments import UsageError, bind_preview
from voxrt.cli.messages import complain, discard_output, set_verbosity

if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import FrameType


class ExitCode(IntEnum):
    """What a finished command tells the program that started it."""

    DONE = 0
    BUG = 1
    USAGE = 2
    ASSET = 3
    DOES_NOT_FIT = 4
    SIMULATOR = 5
    HUNG_UP = 128 + signal.SIGHUP
    INTERRUPTED = 128 + signal.SIGINT
    PIPE_CLOSED = 128 + signal.SIGPIPE
    TERMINATED = 128 + signal.SIGTERM


class Terminated(BaseException):
    """SIGTERM or SIGHUP arrived: unwind, clean up, leave."""


app = cyclopts.App(
    name="voxrt",
    version=voxrt.__version__,
    version_flags=("--version", "-V"),
    help="Meshes to voxels to an octree memory to pictures ray-traced by hardware.",
    help_epilogue="Example: voxrt build courtyard.glb -o out --preview",
    help_format="plaintext",
    default_parameter=cyclopts.Parameter(negative=()),
    result_action="return_value",
    exit_on_error=False,
    print_error=False,
    suppress_keyboard_interrupt=False,
)


def _add_command(name: str, purpose: str, example: str) -> None:
    # Named by text: a command is imported when it is called.
    app.command(
        f"voxrt.cli.{name}:{name}", name=name, help=purpose, help_epilogue=f"Example: {example}", help_format="markdown"
    )


_add_command(
    "build",
    "Build an asset's octree memory: NAME.mem, its manifest NAME.json and a preview picture.",
    "voxrt build courtyard.glb -o out --depth 7 --preview",
)
_add_command(
    "render",
    "Render a picture of a memory, with the same pixels as the hardware.",
    "voxrt render courtyard.mem -o courtyard.png --position -20,40,180 --look 1,-1,-4",
)
_add_command(
    "compare",
    "Compare a memory with the meshes that it was built from.",
    "voxrt compare courtyard.mem courtyard.glb -o likeness.png",
)
_add_command(
    "view",
    "Show the octants of a memory or of an asset: in a window, as a picture, or as a file for other programs.",
    "voxrt view courtyard.mem --ray 320,240 --screenshot ray.png",
)
_add_command(
    "trace",
    "Print the path of one pixel's ray through the octree, word by word.",
    "voxrt trace courtyard.mem --pixel 320,240",
)
_add_command(
    "serve",
    "Show scenes live in the browser, until interrupted.",
    "voxrt serve courtyard.mem dog.usda",
)
_add_command(
    "upload",
    "Let a running board show another scene.",
    "voxrt upload courtyard.mem --to http://127.0.0.1:8080/",
)
_add_command(
    "bitstream",
    "Make the bitstream of a board that shows a scene on its monitor.",
    "voxrt bitstream courtyard.glb --board ulx3s-85f --load",
)
_add_command("convert", "Write a memory in another format.", "voxrt convert courtyard.mem courtyard.blob")
_add_command("info", "Print what a memory holds: sizes, levels, materials.", "voxrt info courtyard.mem")
_add_command(
    "core",
    "Show the configurations of the hardware, or give its sources to a design of your own.",
    "voxrt core --config octo --verilog octo.v",
)
_add_command(
    "completion",
    "Print a script for command-line completion, to be read by a shell at its start.",
    'echo "source <(voxrt completion bash)" >> ~/.bashrc',
)
_add_command("diff", "Compare the voxels of two memories.", "voxrt diff before.mem after.mem")


_add_command("help", "Print the help of a command, or of all.", "voxrt help build")


def run(arguments: Sequence[str]) -> ExitCode:
    """Run a command line and tell its exit code; an error is one line on standard error."""
    try:
        _take_signals()
        command, bound, _ = app.parse_args(bind_preview(arguments))
        set_verbosity(bound.arguments.get("reporting"))
        command(*bound.args, **bound.kwargs)
        sys.stdout.flush()
    except KeyboardInterrupt:
        complain("interrupted: every file is as it was, or complete")
        return ExitCode.INTERRUPTED
    except Terminated as signalled:
        complain("terminated: every file is as it was, or complete")
        return ExitCode(128 + signalled.args[0])
    except SystemExit:
        return ExitCode.PIPE_CLOSED  # rich, showing help, found that nobody reads
    except BrokenPipeError:
        discard_output()  # nobody reads it any more
        return ExitCode.PIPE_CLOSED
    except Exception as error:  # noqa: BLE001 - the outermost frame: everything becomes a line and an exit code
        if "--debug" in arguments:
            traceback.print_exc()
        return _explain(error, arguments)
    return ExitCode.DONE


def _take_signals() -> None:
    """Let signals unwind what runs. Those that whoever started the process ignores stay ignored."""
    for number, handler in (
        (signal.SIGINT, signal.default_int_handler),
        (signal.SIGTERM, _terminate),
        (signal.SIGHUP, _terminate),
    ):
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, handler)
    sys.unraisablehook = _raise_again


def _raise_again(unraisable: sys.UnraisableHookArgs) -> None:
    """Send a signal again whose exception came where Python can only report it, as in the callback of a reference."""
    match unraisable.exc_value:
        case KeyboardInterrupt():
            number = signal.SIGINT
        case Terminated():
            number = signal.Signals(unraisable.exc_value.args[0])
        case _:
            sys.__unraisablehook__(unraisable)
            return
    threading.Timer(0.01, os.kill, (os.getpid(), number)).start()


def _explain(error: Exception, arguments: Sequence[str]) -> ExitCode:
    """Say in one line what went wrong, and in a number whose fault it is."""
    problem, code = str(error), ExitCode.BUG
    match error:
        case ImportError():
            problem = f"this installation of voxrt is not complete: {problem}; install it again"
        case cyclopts.CycloptsError() | UsageError():
            command = [name for name in arguments[:1] if name in app]
            problem, code = f"{problem.rstrip('.')}; see {' '.join(['voxrt', *command, '--help'])}", ExitCode.USAGE
        case voxrt.OutputError() | voxrt.ViewpointError() | voxrt.NoSuchConfigurationError():
            code = ExitCode.USAGE
        case voxrt.AssetError() | voxrt.RomError():
            code = ExitCode.ASSET
        case voxrt.DoesNotFitError():
            code = ExitCode.DOES_NOT_FIT
        case MemoryError():
            problem, code = "out of memory; use a smaller --depth or a larger --voxel-size", ExitCode.DOES_NOT_FIT
        case voxrt.SimulatorError() | voxrt.ViewerError() | voxrt.ToolError():
            code = ExitCode.SIMULATOR
        case OSError():  # the machine's fault: no room, no more files, a stream that is closed
            if not error.filename:
                discard_output()
            problem, code = f"{error.filename or 'standard output'}: {error.strerror or problem}", ExitCode.USAGE
        case _:
            system = f"Python {platform.python_version()}, {platform.system()} {platform.machine()}"
            problem = (
                f"this is a bug of voxrt: {type(error).__name__}: {problem}; please report it with the command, its "
                f"files and what --debug adds (voxrt {voxrt.__version__}, {system})"
            )
    complain(problem)
    return code


def _terminate(number: int, _frame: FrameType | None) -> NoReturn:
    raise Terminated(number)
