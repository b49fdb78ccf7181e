"""Write what is made of the tables of options.

``docs/conf.py`` makes the manual's page of all commands, docs/reference/options.rst, when the manual is built.
``python docs/make_options.py`` writes ``voxrt/options/keywords.py``, by which type checkers know the options as
keywords of functions; a test compares the two.
"""

from __future__ import annotations

from pathlib import Path

from voxrt.cli.line.command_line import command_options
from voxrt.cli.line.help_text import label, option_text
from voxrt.options.build_options import BuildOptions
from voxrt.options.commands import COMMANDS
from voxrt.options.render_options import RenderOptions

KEYWORDS = Path(__file__).resolve().parents[1] / "voxrt" / "options" / "keywords.py"


def keywords() -> str:
    """Give the text of the module of keywords; what it imports stays."""
    head, *_ = KEYWORDS.read_text(encoding="utf-8").partition("\n\nclass ")
    classes = [head]
    for table in (BuildOptions, RenderOptions):
        fields = "".join(f"    {name}: {kind}\n" for name, kind in table.__annotations__.items())
        name = table.__name__.replace("Options", "Keywords")
        classes.append(f'\n\nclass {name}(TypedDict, total=False):\n    """:class:`{table.__name__}`."""\n\n{fields}')
    return "".join(classes)


def page() -> str:
    """Give the text of the page of all commands and their options."""
    title = "Options of the commands"
    lines = [title, "=" * len(title), ""]
    for command, about in COMMANDS.items():
        options = command_options(command)
        heading = f"voxrt {command}"
        lines += [heading, "-" * len(heading), "", _escaped(about.purpose), "", f"``{about.example}``", ""]
        for group in dict.fromkeys(option.group for option in options.values()):
            lines += [f"**{group}**", ""]
            for name, option in options.items():
                if option.group == group:
                    lines += [f"``{label(name, option)}``", f"   {_escaped(option_text(option, options))}", ""]
    return "\n".join(lines)


def write(folder: Path) -> None:
    """Write the page."""
    (folder / "options.rst").write_text(page(), encoding="utf-8")


def _escaped(text: str) -> str:
    return "".join(f"\\{c}" if c in "*`|_\\" else c for c in text)


if __name__ == "__main__":
    KEYWORDS.write_text(keywords(), encoding="utf-8")
