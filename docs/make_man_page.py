"""Write the manual page ``voxrt(1)`` from the tables of options: ``python docs/make_man_page.py build/voxrt.1``.

The build of the wheel calls it, so that ``man voxrt`` and ``man voxrt-build`` show the page where voxrt is installed.
"""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))  # the checkout's, which need not be installed

import voxrt
from voxrt.cli.line.command_line import command_options
from voxrt.cli.line.help_text import label, option_text
from voxrt.options.commands import COMMANDS
from voxrt.options.tasks import TASKS


def man_page() -> str:
    """Give the text of the page, for troff with the macros of ``man``."""
    lines = [
        ".nr HY 0",  # words stay whole, as they are typed
        f'.TH VOXRT 1 "" "voxrt {voxrt.__version__}"',
        ".SH NAME",
        r"voxrt, voxrt\-build \- meshes to voxels to an octree memory to pictures ray\-traced by hardware",
        ".SH SYNOPSIS",
        ".B voxrt",
        r"COMMAND [OPTIONS]",
        ".br",
        r".B voxrt\-build",
        r"ASSET... [OPTIONS]",
        ".SH DESCRIPTION",
        r"voxrt\-build is voxrt build.",
        ".SH EXAMPLES",
    ]
    for purpose, commands in TASKS.values():
        lines += [".PP", _text(purpose), ".PP", ".EX"]
        lines += [_text(f"    {line}  # {comment}") for line, comment in commands]
        lines += [".EE"]
    lines += [".SH COMMANDS"]
    for command, about in COMMANDS.items():
        options = command_options(command)
        lines += [f".SS {_text(f'voxrt {command}')}", _text(f"{about.purpose} {about.more}".rstrip())]
        for name, option in options.items():
            lines += [".TP", f".B {_text(label(name, option))}", _text(option_text(option, options))]
    return "\n".join(lines) + "\n"


def _text(text: str) -> str:
    """Return a text that troff shows as it is."""
    for shown, escape in (("\\", r"\e"), ("-", r"\-"), ("'", r"\(aq"), ('"', r"\(dq"), ("`", r"\(ga")):
        text = text.replace(shown, escape)
    return f"\\&{text}" if text.startswith(".") else text


if __name__ == "__main__":
    target = Path(sys.argv[1])
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(man_page(), encoding="utf-8")
