"""The npm package: packed by npm, unpacked, and used as its README says."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import tarfile
from typing import TYPE_CHECKING

import numpy as np
import pytest
from fakes.site import ROOT, site

import voxrt

if TYPE_CHECKING:
    from pathlib import Path

PACKAGE = ROOT / "build" / "web" / "package"


@pytest.fixture
def installed(tmp_path: Path) -> Path:
    """A folder with the packed package and three.js below node_modules."""
    site()
    if shutil.which("npm") is None:
        pytest.skip("no npm here: apt install npm")
    three = ROOT / "web" / "node_modules" / "three"
    if not three.is_dir():
        pytest.skip("three.js is not here: make site")
    modules = tmp_path / "node_modules"
    modules.mkdir()
    subprocess.run(["npm", "pack", "--silent", str(PACKAGE)], cwd=tmp_path, check=True, capture_output=True)
    (archive,) = tmp_path.glob("voxrt-*.tgz")
    with tarfile.open(archive) as packed:
        packed.extractall(modules, filter="data")
    (modules / "package").rename(modules / "voxrt")
    (modules / "three").symlink_to(three)
    return tmp_path


def test_the_readme_voxelizes_a_mesh_of_three(installed: Path) -> None:
    readme = (installed / "node_modules" / "voxrt" / "README.md").read_text()
    (program,) = re.findall(r"```js\n(.*?)```", readme, re.DOTALL)
    assert len(program.strip().splitlines()) <= 10
    (installed / "use.mjs").write_text(program + "\nconsole.log(JSON.stringify([...words]));\n")
    done = subprocess.run(["node", "use.mjs"], cwd=installed, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    words = np.array(json.loads(done.stdout.splitlines()[-1]), np.uint32)
    corners = [[x, y, z] for x in (-1, 1) for y in (-0.5, 0.5) for z in (-0.5, 0.5)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    native = voxrt.voxelize_mesh(corners, faces, depth=6, colours=(0, 128, 128))
    assert np.array_equal(words, native.octree.words)


def test_what_the_package_exports_is_in_it(installed: Path) -> None:
    package = installed / "node_modules" / "voxrt"
    known = json.loads((package / "package.json").read_text())
    paths = [path for one in known["exports"].values() for path in (one.values() if isinstance(one, dict) else [one])]
    assert all((package / path).is_file() for path in paths)
    assert (package / "voxrt-view.js").stat().st_size < 120_000
    assert re.search(r"^import|\bimport\(", (package / "voxrt-view.js").read_text()) is None  # it is one file


def test_the_version_is_that_of_voxrt() -> None:
    assert json.loads((ROOT / "web" / "package" / "package.json").read_text())["version"] == voxrt.__version__
