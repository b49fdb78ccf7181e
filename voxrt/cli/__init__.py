"""The commands: ``voxrt``, ``voxrt-build`` and ``python -m voxrt``.

Standard output carries the result of ``--json`` and nothing else; all else goes to standard error.
"""

from __future__ import annotations

import sys

from voxrt.cli.app import run

__all__ = ["main", "main_build"]


def main() -> None:
    """Run ``voxrt`` and exit."""
    sys.exit(run(sys.argv[1:]))


def main_build() -> None:
    """Run ``voxrt-build``, which is ``voxrt build``, and exit."""
    sys.exit(run(["build", *sys.argv[1:]]))
