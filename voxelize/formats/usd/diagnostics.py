"""USD's own diagnostics: caught and reported in one line, never printed."""

from __future__ import annotations

import os
import re
from contextlib import contextmanager
from typing import TYPE_CHECKING

from pxr import Tf, UsdUtils

from voxrt.voxelize.errors import AssetError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from voxrt.voxelize.warning_log import WarningLog

# A parser's message: FILE:LINE:COLUMN: what is wrong at 'text' in </prim>
_AT_LINE = re.compile(r"^(?P<file>.*?):(?P<line>\d+):\d+: (?P<problem>.*)", re.DOTALL)

# How USD's bindings begin the message where Python has no type for a value.
_NO_CONVERTER = "No to_python"

_PRIM = re.compile(r"[<(]/[^<>()]*[>)]")

_UNOPENED = re.compile(r"Could not open asset @(?P<asset>[^@]*)@")


@contextmanager
def caught(path: Path, log: WarningLog) -> Iterator[None]:
    """Turn USD's errors into :class:`AssetError` and its warnings into log while the block runs.

    While a delegate is installed, USD prints nothing.
    """
    delegate = UsdUtils.CoalescingDiagnosticDelegate()
    try:
        yield
    except Tf.ErrorException as error:
        raise _asset_error(path, error) from None
    except UnicodeDecodeError as error:  # a message or a value of the file, on its way to Python
        raise AssetError(path, f"holds text that is not UTF-8 ({error.reason})", fix="export it again") from None
    except TypeError as error:  # a value of another type than belongs there
        if not str(error).startswith(_NO_CONVERTER):
            raise
        raise AssetError(path, "holds a value of a type that does not belong there", fix="export it again") from None
    finally:
        diagnostics = [_warning(_commentary(one), path) for one in delegate.TakeUncoalescedDiagnostics()]
        alike: dict[tuple[str, str], str] = {}  # the first of those that differ in the path of the prim alone
        for kind, message in sorted(diagnostics):  # USD composes in threads, which report in any order
            log.add(kind, alike.setdefault((kind, _PRIM.sub("", message)), message))
        del delegate


_MOST_SHOWN = 1000  # characters of a diagnostic


def _commentary(diagnostic: object) -> str:
    """Return the text of a diagnostic, which may quote bytes of the file that are not text, and paths of any length."""
    try:
        text = str(getattr(diagnostic, "commentary", diagnostic))
    except UnicodeDecodeError:
        return "the file holds text that is not UTF-8"
    return text if len(text) <= _MOST_SHOWN else f"{text[:_MOST_SHOWN]}…"


_ADDRESS = re.compile(r"(?:@anon:0x[0-9a-f]+(?::[^@]*)?@|\s*<?\b0x[0-9a-f]{6,}\b>?)")


def _reproducible(line: str, path: Path) -> str:
    """Return a message without addresses in memory, and with files relative to the asset's folder.

    A manifest must not depend on where a folder is, nor on the run.
    """
    line = _ADDRESS.sub(lambda found: "the session layer" if found[0].startswith("@") else "", line)
    folders = sorted({str(path.parent.absolute()), str(path.parent.resolve())}, key=len, reverse=True)
    for folder in folders:
        line = line.replace(folder.rstrip("/") + "/", "")
    return _ABSOLUTE.sub(lambda found: f"@{os.path.relpath(found[1], path.parent.absolute())}", line)


_ABSOLUTE = re.compile(r"@(/[^@\[]*)")


def _warning(commentary: str, path: Path) -> tuple[str, str]:
    line = _reproducible(" ".join(commentary.split()), path)
    if "deprecated version" in line:
        return "deprecated-format", "a layer has a version of the crate format that USD will drop"
    if match := _UNOPENED.search(line):
        return "composition", f"asset {match['asset']} could not be opened; its content is missing"
    return ("composition" if line.startswith("In <") else "usd"), f"USD reports: {line}"


def _asset_error(path: Path, error: Tf.ErrorException) -> AssetError:
    messages = [" ".join(_commentary(one).split()) for one in error.args]
    if any("bad_alloc" in message for message in messages):
        raise MemoryError from None
    for message in messages:
        if match := _AT_LINE.match(message):
            problem = match["problem"]
            # PEGTL, USD's parser, names its C++ templates; the text that it met follows " at '".
            if problem.startswith("parse error matching"):
                problem = "syntax error" + problem[problem.rfind(" at '") :]
            return AssetError(path, problem, place=f"line {match['line']}", fix="repair the file or export it again")
    problem = messages[0] if messages else "cannot be read"
    return AssetError(path, f"USD reports: {problem}", fix="check it with usdchecker")
