"""``voxrt convert``: every format to every other without losing a voxel."""

from __future__ import annotations

import msgspec
import pytest

import voxrt as library
from voxrt.cli.results.memory_results import ConvertResult


def test_around_all_formats(voxrt, built):
    source = "house.mem"
    for suffix in (".coe", ".mif", ".bin", ".blob", ".mem"):
        target = f"out/turned{suffix}"
        finished = voxrt.succeeds("convert", source, target, "--json")
        result = msgspec.json.decode(finished.out, type=ConvertResult, strict=True)
        assert result.outputs[0] == target
        assert all((built / output).is_file() for output in result.outputs)
        source = target
    assert (built / "out/turned.mem").read_bytes() == (built / "house.mem").read_bytes()
    assert voxrt.json("diff", "house.mem", "out/turned.blob")["voxels"] == 0
    turned, _ = library.read_rom(built / "out/turned.mem")
    assert turned.materials == library.read_rom(built / "house.mem")[0].materials
    assert voxrt("info", "out/turned.blob").code == 0
    assert voxrt("render", "out/turned.blob", "-o", "a.png", "--engine", "model", "--size", "16x12").code == 0


@pytest.mark.parametrize("suffix", [".vox", ".npz", ".ply", ".glb", ".vtu", ".html"])
def test_files_for_other_programs(voxrt, built, suffix):
    if suffix == ".vtu":
        pytest.importorskip("pyvista", reason="PyVista is not installed")
    assert voxrt.json("convert", "house.mem", f"new/house{suffix}")["outputs"] == [f"new/house{suffix}"]
    first = (built / f"new/house{suffix}").read_bytes()
    assert len(first) > 1000
    assert voxrt("convert", "house.mem", f"again{suffix}").code == 0
    assert (built / f"again{suffix}").read_bytes() == first


def test_every_form_has_a_writer():
    assert library.WRITABLE_SUFFIXES == (
        ".mem", ".coe", ".mif", ".bin", ".blob", ".vox", ".npz", ".ply", ".glb", ".vtu", ".html"
    )  # fmt: skip


def test_another_dialect(voxrt, built):
    assert voxrt("convert", "house.mem", "old.mem", "--dialect", "seed-rtl").code == 0
    assert "FFFFFFF0" in (built / "old.mem").read_text().split()
    (built / "old.json").unlink()
    assert voxrt("convert", "old.mem", "new.mem", "--from-dialect", "seed-rtl", "--depth", "5").code == 0
    assert voxrt.json("diff", "house.mem", "new.mem")["voxels"] == 0


def test_a_listing_with_its_materials(voxrt, folder):
    children = "".join(
        f"Node {i}: Material ID = {'Roof (Instance)' if i == 8 else 'None'}, MID1 = False\n" for i in range(1, 9)
    )
    (folder / "scene.txt").write_text(f"Node 0: Material ID = None, MID1 = False, First Child Index = 1\n{children}")
    assert voxrt("convert", "scene.txt", "scene.mem", "--material", "Roof=#d65438").code == 0
    info = voxrt.json("info", "scene.mem")
    assert info["voxels"] == 1
    assert info["materials"][1] == {"id": 1, "name": "Roof", "colour": [214, 84, 56], "voxels": 1}
    assert voxrt("convert", "scene.txt", "scene.mem").code == 3


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["house.mem", "house.png"], 2, "not a format to write"),
        (["house.mem", "house.blob", "--material", "Roof"], 2, "NAME=RRGGBB"),
        (["house.mem", "house.blob", "--material", "Roof=red"], 2, "NAME=RRGGBB"),
        (["house.mem", "house.obj/deeper.blob"], 2, "is a file, not a folder"),
        (["nothing.mem", "house.blob"], 3, "nothing.mem"),
        (["broken.obj", "house.blob"], 3, "broken.obj"),
    ],
)
def test_refusals(voxrt, built, arguments, code, message):
    (built / "broken.obj").write_text("f 1 2 3\n")
    voxrt.fails(code, message, "convert", *arguments)
