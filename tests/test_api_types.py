"""Type checkers see the public names and no others."""

from __future__ import annotations

import ast
import shutil
import subprocess
import sys
from pathlib import Path
from typing import get_args

import pytest

import voxrt
from voxrt import export, octree, sim, view, voxelize
from voxrt.options import build_options
from voxrt.options.build_options import BuildOptions
from voxrt.voxelize import authoring

ROOT = Path(__file__).resolve().parents[1]

GOOD = """\
import voxrt
from voxrt.octree import *
from voxrt.sim import *
from voxrt import BuildOptions

built = voxrt.build("a.glb", "out", depth=8, fill="surface")
built = voxrt.build("a.glb", options=BuildOptions(depth=8))
size: int = built.octree.size
voxels = to_dense(built.octree)
frame: Frame = voxrt.render(built.rom, engine="model")
frame = voxrt.render(built.rom, options=voxrt.RenderOptions(size=(64, 48)))
hits = voxrt.cast_rays(built.octree, [[0, 0, 0]], [[1, 0, 0]]).voxel
points = voxrt.octree.to_points(built.octree)
"""

BAD = """\
import voxrt
from voxrt import vozelize
import voxrt.octree as o

voxrt.vozelize("a.glb")
voxrt.build("a.glb", dept=8)
voxrt.build("a.glb", fill="half")
voxrt.BuildOptions(depths=8)
voxrt.BuildOptions().depths
voxrt.RenderOptions(engin="model")
voxrt.render(None, engin="model")
o.to_dens(None)
voxrt.sim.rendr
"""
WRONG_LINES = {2, *range(5, 14)}


def lines_with_errors(command, folder, text):
    """The numbers of the lines of which a type checker complains."""
    file = folder / "names.py"
    file.write_text(text)
    finished = subprocess.run([*command, file], cwd=ROOT, capture_output=True, text=True, check=False)
    found = set()
    for line in finished.stdout.splitlines():
        _, _, rest = line.partition("names.py:")
        if rest and "error" in rest:
            found.add(int(rest.split(":")[0]))
    assert found or finished.returncode == 0, finished.stdout + finished.stderr
    return found


SAMPLES = pytest.mark.parametrize(("text", "wrong"), [(GOOD, set()), (BAD, WRONG_LINES)], ids=["good", "bad"])


@SAMPLES
def test_mypy_sees_misspelt_names(tmp_path, text, wrong):
    pytest.importorskip("mypy")
    # The file is checked; the package is read for its names alone.
    command = [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent", "--cache-dir", tmp_path / "cache"]
    assert lines_with_errors(command, tmp_path, text) == wrong


@SAMPLES
def test_pyright_sees_misspelt_names(tmp_path, text, wrong):
    if shutil.which("pyright") is None:
        pytest.skip("pyright is not installed")
    assert lines_with_errors(["pyright", "--pythonpath", sys.executable], tmp_path, text) == wrong


def test_every_public_name_is_there_at_run_time():
    assert all(getattr(voxrt, name) is not None for name in voxrt.__all__)
    with pytest.raises(AttributeError, match="no attribute 'vozelize'"):
        voxrt.vozelize  # noqa: B018


@pytest.mark.parametrize(
    "package", [voxrt, octree, export, sim, view, voxelize, authoring], ids=lambda package: package.__name__
)
def test_a_package_exports_what_its_stub_lists(package):
    stub = ast.parse(Path(package.__file__).with_suffix(".pyi").read_text())
    listed = {alias.asname for node in stub.body if isinstance(node, ast.ImportFrom) for alias in node.names}
    names = {}
    exec(f"from {package.__name__} import *", names)
    assert listed == set(package.__all__) == set(names) - {"__builtins__"}
    assert listed == set(dir(package)) - {"__version__"}


def test_the_choices_are_those_of_the_rooms():
    from voxrt.voxelize.assets import UpAxis
    from voxrt.voxelize.box_rounding import Pow2
    from voxrt.voxelize.object_proxies import Geometry

    assert get_args(build_options.Dialect) == octree.DIALECTS
    assert get_args(build_options.Engine) == get_args(sim.Engine)
    assert get_args(build_options.Geometry) == get_args(Geometry)
    assert get_args(build_options.Pow2) == get_args(Pow2)
    assert get_args(build_options.UpAxis) == get_args(UpAxis)
    assert BuildOptions().colours == voxelize.DEFAULT_COLOURS
