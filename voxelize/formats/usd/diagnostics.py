"""USD's own diagnostics: caught and reported in one line, never printed."""

from __future__ import annotations

import os
import re
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from pxr import Tf, UsdUtils

from voxrt.voxelize.errors import AssetError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from voxrt.voxelize.warning_log import WarningLog

# A parser's message: FILE:LINE:COLUMN: what is wrong at 'text' in </prim>
_AT_LINE = re.compile(r"^(?P<file>.*?):(?P<line>\d+):\d+: (?P<problem>.*)", re.DOTALL)

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
    finally:
        diagnostics = [_warning(_commentary(one), path) for one in delegate.TakeUncoalescedDiagnostics()]
        for kind, message in sorted(diagnostics):  # USD composes in threads, which report in any order
            log.add(kind, message)
        del delegate


def _commentary(diagnostic: object) -> str:
    """Return the text of a diagnostic, which may quote bytes of the file that are not text."""
    try:
        return str(getattr(diagnostic, "commentary", diagnostic))
    except UnicodeDecodeError:
        return "the file holds text that is not UTF-8"


def _warning(commentary: str, path: Path) -> tuple[str, str]:
    line = " ".join(commentary.split())
    if "deprecated version" in line:
        return "deprecated-format", "a layer has a version of the crate format that USD will drop"
    if match := _UNOPENED.search(line):
        # Relative to the file's folder, so that a manifest does not depend on where that folder is.
        asset = match["asset"]
        if Path(asset).is_absolute():
            asset = os.path.relpath(asset, path.parent.absolute())
        return "composition", f"asset {asset} could not be opened; its content is missing"
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
