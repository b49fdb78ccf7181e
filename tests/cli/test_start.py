"""What commands import before they work, and command lines that are read without the parser."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from voxrt.cli import build as parsed_build
from voxrt.cli import building, messages
from voxrt.cli.plain_build import read_plain_build
from voxrt.cli.run import read_with_parser

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"

LIBRARIES = {"numpy", "msgspec", "PIL", "trimesh", "pxr", "pyvista", "websockets", "asyncio", "concurrent", "http"}
PARSER = {"cyclopts", "rich", "docstring_parser", "attrs"}
OTHER_WORK = {
    "numpy.ma",
    "voxrt.building.baking",
    "voxrt.board",
    "voxrt.building.fitting",
    "voxrt.sources.from_arrays",
    "voxrt.octree.budget",
    "voxrt.views.pictures",
    "voxrt.serve",
    "voxrt.sim._model",
    "voxrt.sim._rtl",
    "voxrt.view",
    "voxrt.voxelize.formats.usd",
}


@pytest.mark.parametrize(
    ("arguments", "unwanted"),
    [
        (["--version"], {*LIBRARIES, *PARSER, *OTHER_WORK}),
        (["build", "--version"], {*LIBRARIES, *PARSER, *OTHER_WORK}),
        (["--help"], {*LIBRARIES, *OTHER_WORK, "markdown_it", "pygments"}),
        (["build", "--help"], {*LIBRARIES, *OTHER_WORK, "markdown_it", "pygments"}),
        (
            ["build", "house.obj", "-o", "out", "--depth", "4"],
            {*LIBRARIES - {"numpy", "msgspec"}, *PARSER, *OTHER_WORK},
        ),
        (["build", "planet.glb", "--json", "-q"], {*LIBRARIES - {"numpy", "msgspec"}, *PARSER, *OTHER_WORK}),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_a_command_imports_what_it_uses(tmp_path, arguments, unwanted):
    for name in ("house.obj", "house.mtl", "planet.glb"):
        shutil.copy(EXAMPLES / name, tmp_path)
    code = (
        "import sys\n"
        "before = set(sys.modules)\n"
        "from voxrt.cli import main\n"
        f"sys.argv = {['voxrt', *arguments]!r}\n"
        "try:\n    main()\n"
        f"finally:\n    print(*({unwanted!r} & set(sys.modules)) - before, file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, check=True, capture_output=True, text=True)
    assert [line for line in done.stderr.splitlines() if "warning" not in line][-1] == ""


def _bound(monkeypatch, read, arguments):
    """Return what a command line asks to be built, and how much is said meanwhile."""
    asked = []
    for module in (building, parsed_build):
        monkeypatch.setattr(module, "build_all", lambda *args, **named: asked.append((args, named)))
    monkeypatch.setattr(messages, "_verbosity", 0)
    read(arguments)()
    ((args, named),) = asked
    return args, {"frames": None, "profile": False, "json": False} | named, messages._verbosity


WORDS = st.sampled_from(
    ["a.obj", "b.glb", "x.mem", "out", "-o", "--output", "--depth", "4", "16", "17", "04", "--depth=5", "--fill"]
)
MORE_WORDS = st.sampled_from(
    ["solid", "surface", "Solid", "", "--json", "--no-json", "-q", "--quiet", "-v", "--verbose", "-qv", "-", "--"]
)


@given(arguments=st.lists(WORDS | MORE_WORDS, max_size=8))
def test_plain_command_lines_mean_the_same_to_the_parser(arguments):
    arguments = ["build", "a.obj", *arguments]
    with pytest.MonkeyPatch.context() as monkeypatch:
        for module in (building, parsed_build):
            monkeypatch.setattr(module, "check_company", lambda *_: None)
        if read_plain_build(arguments) is not None:
            plain = _bound(monkeypatch, read_plain_build, arguments)
            assert plain == _bound(monkeypatch, read_with_parser, arguments)


@pytest.mark.parametrize(
    "arguments",
    [
        ["a.obj"],
        ["a.obj", "b.obj", "-o", "out", "-q"],
        ["--depth", "4", "--json", "--fill", "surface", "-v"],
        ["a.obj", "--depth", "12", "--output", "x.mem"],
    ],
)
def test_common_builds_need_no_parser(arguments):
    has_asset = not arguments[0].startswith("-")
    assert (read_plain_build(["build", *arguments]) is not None) == has_asset


@pytest.mark.parametrize("arguments", [["info", "a.mem"], [], ["build"], ["build", "a.obj", "--depth"]])
def test_all_else_is_left_to_the_parser(arguments):
    assert read_plain_build(arguments) is None
