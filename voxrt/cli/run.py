"""A command line from its words to its exit code: what ends a command, and what that is called."""

from __future__ import annotations

import gc
import os
import signal
import sys
from enum import IntEnum
from importlib import import_module
from typing import TYPE_CHECKING, NoReturn

import voxrt
from voxrt.cli.line.command_line import HELP_FLAGS, asks_for_help, find_command, read_options
from voxrt.cli.terminal.errors import UsageError
from voxrt.cli.terminal.messages import complain, discard_output, print_answer, set_verbosity
from voxrt.options.commands import COMMANDS

if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import FrameType


VERSION_FLAGS = ("--version", "-V")


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


def run(arguments: Sequence[str]) -> ExitCode:
    """Run a command line and tell its exit code; an error is one line on standard error."""
    try:
        _take_signals()
        run_command(arguments)
        sys.stdout.flush()
    except KeyboardInterrupt:
        complain("interrupted: every file is as it was, or complete")
        return ExitCode.INTERRUPTED
    except Terminated as signalled:
        complain("terminated: every file is as it was, or complete")
        return ExitCode(128 + signalled.args[0])
    except BrokenPipeError:
        discard_output()  # nobody reads it any more
        return ExitCode.PIPE_CLOSED
    except Exception as error:  # noqa: BLE001 - the outermost frame: everything becomes a line and an exit code
        if "--debug" in arguments:
            import traceback  # noqa: PLC0415 - as above

            traceback.print_exc()
        return _explain(error, arguments)
    return ExitCode.DONE


def run_command(arguments: Sequence[str]) -> None:
    """Run a command line; UsageError if it cannot be understood."""
    if not arguments or arguments[0] in HELP_FLAGS:
        from voxrt.cli.line.help_text import overview  # noqa: PLC0415 - most commands do without

        print_answer(overview())
        return
    if arguments[0] in VERSION_FLAGS:
        print_answer(f"{voxrt.__version__}\n")
        return
    name, *words = arguments
    find_command(name)
    if asks_for_help(words):
        from voxrt.cli.line.help_text import command_help  # noqa: PLC0415 - as above

        print_answer(command_help(name, full=False))
        return
    options = read_options(name, words)
    reporting = getattr(options, "reporting", None)
    set_verbosity(0 if reporting is None else reporting.verbose - reporting.quiet)
    command = import_module(f"voxrt.cli.commands.{name}")
    if not gc.isenabled():
        gc.freeze()  # what is imported stays: collections need not visit it
        gc.enable()
    command.run(options)


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
    import threading  # noqa: PLC0415 - as above

    threading.Timer(0.01, os.kill, (os.getpid(), number)).start()


def _explain(error: Exception, arguments: Sequence[str]) -> ExitCode:
    """Say in one line what went wrong, and in a number whose fault it is."""
    problem, code = str(error), ExitCode.BUG
    match error:
        case ImportError():
            problem = f"this installation of voxrt is not complete: {problem}; install it again"
        case UsageError():
            command = [name for name in arguments[:1] if name in COMMANDS]
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
            import platform  # noqa: PLC0415 - slow to import

            system = f"Python {platform.python_version()}, {platform.system()} {platform.machine()}"
            problem = (
                f"this is a bug of voxrt: {type(error).__name__}: {problem}; please report it with the command, its "
                f"files and what --debug adds (voxrt {voxrt.__version__}, {system})"
            )
    complain(problem)
    return code


def _terminate(number: int, _frame: FrameType | None) -> NoReturn:
    raise Terminated(number)
