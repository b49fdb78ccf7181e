"""The documentation of :class:`~voxrt.options.build_options.BuildOptions` as help for the command line."""

from __future__ import annotations

import inspect
import re

from voxrt.options.build_options import BuildOptions


def _option_help(documentation: str) -> dict[str, str]:
    """Return the text of each option in a NumPy-style docstring: names and values as the command line spells them."""
    _, _, rest = documentation.partition("Attributes\n----------\n")
    section = re.split(r"\n\n\w+\n-+\n", rest)[0]
    texts: dict[str, list[str]] = {}
    lines: list[str] = []
    for line in section.splitlines():
        if line.startswith(" "):
            lines.append(line.strip())
        else:
            lines = texts.setdefault(line, [])
    return {name: _on_command_line(" ".join(lines)) for name, lines in texts.items()}


def _on_command_line(text: str) -> str:
    text = re.sub(r" In Python, [^.]*\.", "", text)
    text = re.sub(r"``\"?([^`\"]+)\"?``", r"\1", text)
    return re.sub(r"`(\w+)`", lambda name: "--" + name[1].replace("_", "-"), text)


OPTION_HELP = _option_help(inspect.getdoc(BuildOptions) or "")
"""Help by the option's name in Python."""
