"""The reference of the manual describes every name that a package exports."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path

import pytest

DOCS = Path(__file__).resolve().parents[2] / "docs"
ENTRY = re.compile(r"^\.\. (?:auto(?:function|class)|py:data):: (\S+)$", re.MULTILINE)
REFERENCE = re.compile(r"^- ``(\S+)``, :py:\w+:`(\S+)`: \w", re.MULTILINE)
PAGE = re.compile(r"^- :doc:`(\S+)`$", re.MULTILINE)

EXPORTING = ("voxrt", "voxrt.voxelize", "voxrt.octree", "voxrt.export", "voxrt.sim", "voxrt.view")


@pytest.fixture(scope="module")
def pages():
    import make_reference

    return make_reference.pages()


@pytest.fixture(scope="module")
def described(pages):
    return {name for text in pages.values() for name in ENTRY.findall(text)}


@pytest.mark.parametrize("package", EXPORTING)
def test_every_export_is_in_the_reference(package, pages, described):
    elsewhere = dict(REFERENCE.findall(pages[package]))
    rooms = set(PAGE.findall(pages[package])) & set(pages)
    for name in import_module(package).__all__:
        full = f"{package}.{name}"
        assert full in described or elsewhere.get(full) in described or full in rooms, full


@pytest.mark.parametrize(
    "name",
    ["voxrt.board.device.Device", "voxrt.board.register_device.RegisterDevice", "voxrt.serve.server.FrameServer"],
)
def test_packages_without_a_list_of_exports_show_their_public_names(name, described):
    assert name in described


def test_no_private_name_is_in_the_reference(described):
    assert not [name for name in described if any(part.startswith("_") for part in name.split("."))]


def test_every_page_is_in_the_manual(pages):
    listed = (DOCS / "programming.md").read_text(encoding="utf-8")
    for package in pages:
        assert f"\nreference/{package}\n" in listed, package


def test_the_map_names_each_export_once(monkeypatch):
    import make_reference

    for wrong in (("build", "render"), ("buildd",), ()):
        monkeypatch.setitem(make_reference.TASKS, "Build a memory", wrong)
        with pytest.raises(ValueError, match=r"TASKS must name each export of voxrt once: .*'BuildOptions'"):
            make_reference.pages()


def test_constants_have_their_text_and_value(pages):
    assert "Value: ``('report', 'seed-rtl', 'msb', 'lod')``" in pages["voxrt.octree"]


def test_writing_removes_pages_of_packages_that_are_gone(tmp_path):
    import make_reference

    (tmp_path / "voxrt.gone.rst").write_text("old")
    make_reference.write(tmp_path)
    assert {path.stem for path in tmp_path.iterdir()} == {"voxrt", *make_reference.PACKAGES}
