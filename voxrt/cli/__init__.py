"""The commands: ``voxrt``, ``voxrt-build`` and ``python -m voxrt``.

Standard output carries what was asked for: the result of ``--json``, and what ``info``, ``trace``, ``diff``,
``compare`` and ``core`` print. All else goes to standard error.
"""

from __future__ import annotations

import sys

from voxrt.cli.start import end_at_once, start

__all__ = ["main", "main_build", "script", "script_build"]


def main() -> None:
    """Run ``voxrt`` and exit."""
    start(sys.argv[1:])


def main_build() -> None:
    """Run ``voxrt-build``, which is ``voxrt build``, and exit."""
    start(["build", *sys.argv[1:]])


def script() -> None:
    """Run ``voxrt`` as the installed command, after which nothing else runs."""
    end_at_once(main)


def script_build() -> None:
    """Run ``voxrt-build`` as the installed command."""
    end_at_once(main_build)
