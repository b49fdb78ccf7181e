"""What the benchmarks share: folders, options, tables, and the pages in ``bench/results``."""

from __future__ import annotations

import argparse
import os
import platform
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

ROOT = Path(__file__).resolve().parents[1]
ASSETS = Path(os.environ.get("VOXRT_ASSETS", ROOT.parent / "shared" / "assets"))
RESULTS = ROOT / "bench" / "results"


def options_of(documentation: str | None) -> argparse.ArgumentParser:
    """Return a parser with ``--write``, described by the first line of a script's documentation."""
    parser = argparse.ArgumentParser(description=(documentation or "").partition("\n")[0])
    parser.add_argument("--write", action="store_true", help="write the page in bench/results too")
    return parser


def frame_size(text: str) -> tuple[int, int]:
    """Return width and height, from ``640x480``."""
    width, height = (int(side) for side in text.split("x"))
    return width, height


def machine() -> str:
    """Return the machine, its cores and the version of Python."""
    return f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}"


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a Markdown table."""
    return "".join(f"| {' | '.join(row)} |\n" for row in (head, ("---",) * len(head), *rows))


def write_page(name: str, page: str) -> None:
    """Write a page of ``bench/results``."""
    (RESULTS / name).write_text(page, encoding="utf-8")
