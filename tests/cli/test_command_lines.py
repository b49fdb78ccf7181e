"""One command line may be written in many ways, and means the same."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from voxrt.cli.line.command_line import read_options
from voxrt.options.build_command import BuildCommand
from voxrt.options.build_options import BuildOptions
from voxrt.options.shared import ReportOptions

PIECES = (
    (["a.obj"], ["./a.obj"]),
    (["--depth", "4"], ["--depth=4"]),
    (["-o", "out"], ["--output", "out"], ["--output=out"], ["-oout"]),
    (["--fill", "surface"], ["--fill=Surface"]),
    (["--bounds", "-1,-2,-3,1,2,3"], ["--bounds=-1,-2,-3,1,2,3"]),
    (["--ignore", "roof"], ["--ignore=roof"]),
    (["--preview"], ["--preview="]),
    (["--json", "-q"], ["--json", "--quiet"]),
)
MEANING = BuildCommand(
    assets=(Path("a.obj"),),
    output=Path("out"),
    options=BuildOptions(depth=4, fill="surface", bounds=(-1, -2, -3, 1, 2, 3), ignore=("roof",), preview=True),
    reporting=ReportOptions(json=True, quiet=True),
)


@given(st.permutations(PIECES), st.lists(st.integers(0, 3), min_size=len(PIECES), max_size=len(PIECES)))
def test_order_and_spelling_do_not_matter(pieces, spellings):
    words = [word for ways, row in zip(pieces, spellings, strict=True) for word in ways[row % len(ways)]]
    assert read_options("build", words) == MEANING


@pytest.mark.parametrize(
    ("words", "preview", "assets"),
    [
        (["--preview", "a.obj"], True, ("a.obj",)),
        (["--preview", "b.png", "a.obj"], "b.png", ("a.obj",)),
        (["a.obj", "--preview", "--json"], True, ("a.obj",)),
        (["a.obj", "--preview"], True, ("a.obj",)),
        (["a.obj", "--", "--preview", "-b.obj"], False, ("a.obj", "--preview", "-b.obj")),
    ],
)
def test_the_value_of_preview_is_optional(words, preview, assets):
    command = read_options("build", words)
    assert command.options.preview == (Path(preview) if isinstance(preview, str) else preview)
    assert command.assets == tuple(map(Path, assets))


def test_options_that_repeat_are_collected():
    command = read_options("build", ["a.obj", "--variant", "red", "--ignore=x", "--variant=blue"])
    assert command.options.variants == ("red", "blue")
    assert command.options.ignore == ("x",)
