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

USER_ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
"""The variables of processes whose start is measured. Users' installs have compiled modules; where Python may not write
them, each process would compile all of them."""


def options_of(documentation: str | None) -> argparse.ArgumentParser:
    """Return a parser with ``--write``, described by the first line of a script's documentation."""
    parser = argparse.ArgumentParser(description=(documentation or "").partition("\n")[0])
    parser.add_argument("--write", action="store_true", help="write the page in bench/results too")
    return parser


def frame_size(text: str) -> tuple[int, int]:
    width, height = (int(side) for side in text.split("x"))
    return width, height


def machine() -> str:
    return f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}"


def table(head: Sequence[str], rows: Iterable[Sequence[str]], left: int | None = None) -> str:
    """Return a Markdown table; the columns after the first `left` ones are numbers, which stand at the right."""
    rule = ["---" if left is None or column < left else "--:" for column in range(len(head))]
    return "".join(f"| {' | '.join(row)} |\n" for row in (head, rule, *rows))


def publish(name: str, page: str, *, write: bool) -> None:
    """Print a page of ``bench/results``, and write it if so wanted."""
    print(page, end="")
    if write:
        write_page(name, page)


def write_page(name: str, page: str) -> None:
    (RESULTS / name).write_text(page, encoding="utf-8")
