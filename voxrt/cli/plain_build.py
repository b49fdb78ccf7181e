"""Command lines of ``voxrt build`` that need no parser: assets, and the options that most builds have.

The parser and its tables of all options take as long to make as a small build. What is read here means the same to it;
it reads all else, and everything that is wrong.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, get_args

from voxrt.cli.messages import set_verbosity

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

_FLAGS = {"--json": "json", "--quiet": "quiet", "-q": "quiet", "--verbose": "verbose", "-v": "verbose"}
_VALUES = {"--output": "output", "-o": "output", "--depth": "depth", "--fill": "fill"}
_DEPTHS = tuple(map(str, range(1, 17)))


def read_plain_build(arguments: Sequence[str]) -> Callable[[], None] | None:
    """Return the build that a command line asks for; None where the parser has to read it."""
    if arguments[:1] != ["build"]:
        return None
    said: dict[str, str] = {}
    assets: list[str] = []
    words = iter(arguments[1:])
    for word in words:
        name = _FLAGS.get(word) or _VALUES.get(word)
        value = next(words, "") if word in _VALUES else word
        if name is None:
            if not word or word.startswith("-") or said:
                return None
            assets.append(word)
        elif name in said or not value or (word in _VALUES and value.startswith("-")):
            return None
        else:
            said[name] = value
    depth = said.get("depth")
    if not assets or depth not in (None, *_DEPTHS):
        return None
    from voxrt.cli.building import build_all, check_company  # noqa: PLC0415 - as above
    from voxrt.options.build_options import BuildOptions, Fill  # noqa: PLC0415 - other commands do without

    fill: Fill | None = next((one for one in get_args(Fill) if one == said.get("fill", BuildOptions.fill)), None)
    if fill is None:
        return None

    def run() -> None:
        paths, output = tuple(map(Path, assets)), Path(said.get("output", ""))
        check_company(paths, output, None)
        options = BuildOptions(depth=None if depth is None else int(depth), fill=fill)
        build_all(paths, output, options, json="json" in said)

    set_verbosity(("verbose" in said) - ("quiet" in said))
    return run
