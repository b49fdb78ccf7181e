"""What the commands say: answers on standard output, all else on standard error."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from typing import TYPE_CHECKING

from voxrt.export.outputs import OutputError

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from voxrt.building.fitting import BudgetFit
    from voxrt.octree import Animation
    from voxrt.sim import CacheCost, EngineCheck, Frame
    from voxrt.voxelize import SceneWarning

_PRINTED_OF_A_KIND = 20
"""Warnings of a kind that are printed without --verbose."""

_verbosity = 0  # -1 quiet, 1 verbose: one command runs per process


def set_verbosity(verbosity: int) -> None:
    """Choose how much is said from now on: 1 for --verbose, -1 for --quiet."""
    global _verbosity  # noqa: PLW0603 - as the signals and the streams are
    _verbosity = verbosity


def printable(text: object) -> str:
    """Make one line of a text, with what a terminal would act on, and what is no text at all, spelled out."""
    return "".join(c if c.isprintable() else c.encode("unicode_escape").decode() for c in str(text))


def complain(problem: str) -> None:
    """Print an error, one line."""
    _print(f"voxrt: error: {printable(problem)}")


def warn(warnings: Iterable[SceneWarning]) -> None:
    """Print warnings, a line each. Of very many of a kind the first are printed; the manifest has them all."""
    kinds: dict[str, list[SceneWarning]] = {}
    for warning in warnings:
        kinds.setdefault(warning.kind, []).append(warning)
    for kind, alike in kinds.items():
        printed = alike if _verbosity > 0 else alike[:_PRINTED_OF_A_KIND]
        for warning in printed:
            _print(f"voxrt: warning: {printable(warning)}")
        if len(alike) > len(printed):
            _print(f"voxrt: warning: ... and {len(alike) - len(printed)} more of the kind {kind!r} (-v shows all)")


def summarize(title: str, rows: Iterable[tuple[str, str]], *, answer: bool = False) -> None:
    """Print a title and aligned rows of a name and a value: what was done, or the answer that was asked for."""
    _say([printable(title), *(f"  {name:<10} {printable(value)}" for name, value in rows)], answer=answer)


def tabulate(heads: tuple[str, ...], rows: list[tuple[str, ...]], *, answer: bool = False) -> None:
    """Print a table, numbers to the right."""
    rows = [tuple(map(printable, row)) for row in rows]
    widths = [max(len(row[column]) for row in [heads, *rows]) for column in range(len(heads))]
    right = [
        all(row[column].replace(",", "").replace(".", "").isdigit() for row in rows) for column in range(len(heads))
    ]
    lines = []
    for row in [heads, *rows]:
        cells = zip(row, widths, right, strict=True)
        lines.append(
            "  " + "  ".join(cell.rjust(wide) if number else cell.ljust(wide) for cell, wide, number in cells).rstrip()
        )
    _say(lines, answer=answer)


def print_answer(text: str) -> None:
    """Print text that was asked for on standard output.

    OutputError if standard output cannot be written to, other than because nobody reads it any more.
    """
    try:
        sys.stdout.write(text.encode(sys.stdout.encoding, "backslashreplace").decode(sys.stdout.encoding))
        sys.stdout.flush()
    except BrokenPipeError:
        raise
    except OSError as error:
        discard_output()
        raise OutputError(f"standard output: {error.strerror}") from error


def picture_cost(frame: Frame, engine: str) -> str:
    """Return the cost of a picture in one line."""
    height, width = frame.material.shape
    cost = frame.cost
    cycles = "" if cost.cycles is None else f"{cost.cycles / cost.rays:.2f} cycles per pixel, "
    words = "" if cost.words_read is None else f"{cost.words_read / cost.rays:.2f} words per ray, "
    rays = cost.rays // (width * height)
    samples = f", {rays} rays per pixel," if rays > 1 else ""
    return f"{width}x{height}{samples} by {engine}: {cycles}{words}{cost.seconds:.2f} s"


def check_text(check: EngineCheck) -> str:
    """Return in one line what comparing the engines found, and what the hardware took."""
    cost = check.rtl.cost
    cycles = "" if cost.cycles is None else f", {cost.cycles / cost.rays:.2f} cycles per pixel"
    return f"{check.wrong_pixels:,} of {check.wrong.size:,} pixels differ{cycles}"


def frames_row(animation: Animation, words: int) -> str:
    """Return in one line how many frames a memory holds, and what it saves by sharing their blocks."""
    count, alone = len(animation.frames), animation.words_alone
    times = [frame.time for frame in animation.frames if frame.time is not None]
    when = f" of {times[0]:g} to {times[-1]:g} s" if times else ""
    return f"{count}{when}; {alone:,} words alone, of which {words / alone:.2f} when equal blocks are shared"


def cache_cost(cost: CacheCost, pixels: int) -> str:
    """Return what a picture cost at the caches, in one line."""
    return (
        f"L1 hits {100 * cost.l1_hits:.1f} %, L2 hits {100 * cost.l2_hits:.1f} %, "
        f"{cost.lines_read / pixels:.3f} lines and {cost.bytes_read / pixels:.1f} bytes per pixel"
    )


def budget_loss(budget: BudgetFit, *, by_touch: bool = False) -> str:
    """Say what a memory that does not fit gives up, and what looks nearer; nothing if it gives up little."""
    if budget.lossless is None:
        return ""
    depth, words = budget.lossless
    nearer = "; coarse voxels look nearer to the source with --rule centre" if by_touch else ""
    return (
        f"{budget.words:,} words give up {budget.fit.percent_changed:.0f} % of the surface; "
        f"--depth {depth} fits without loss, in {words:,} words{nearer}"
    )


def budget_text(budget: BudgetFit) -> str:
    """Say what fitting a budget took."""
    fit = budget.fit
    if not (fit.changed or fit.appeared or fit.recoloured):
        return f"{budget.words:,} words are enough, nothing is given up"
    return (
        f"{budget.words:,} of {fit.words_shared:,} words: {fit.percent_changed:.2f} % of the surface changed, "
        f"PSNR {budget.psnr:.1f} dB, SSIM {budget.ssim:.3f}"
    )


def discard_output() -> None:
    """Let what standard output still holds go nowhere, where the interpreter flushes it at its end."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)


def is_verbose() -> bool:
    """Tell whether --verbose was given."""
    return _verbosity > 0


def is_quiet() -> bool:
    """Tell whether --quiet was given."""
    return _verbosity < 0


def note(text: str) -> None:
    """Print a line about what goes on."""
    if _verbosity >= 0:
        _print(f"voxrt: {printable(text)}")


def name_file(path: Path) -> str:
    """Give a file's name as text, for JSON; bytes of the name that are no text are spelled out."""
    return os.fsencode(path).decode("utf-8", "backslashreplace")


def _say(lines: list[str], *, answer: bool) -> None:
    if answer:
        print_answer("".join(f"{line}\n" for line in lines))
    elif _verbosity >= 0:
        for line in lines:
            _print(line)


def _print(line: str) -> None:
    with suppress(OSError):  # nobody listens: the work is done all the same
        print(line, file=sys.stderr)  # noqa: T201 - the one place that does
