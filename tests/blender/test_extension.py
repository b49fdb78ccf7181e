"""The extension as one archive: Blender's own tool checks it, and a Blender without voxrt installs and runs it."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
import sysconfig
import tomllib
import zipfile
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy", reason="Blender's module bpy is not here: make blender-test")

import voxrt  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def packer():
    spec = importlib.util.spec_from_file_location("make_extension", ROOT / "blender" / "make_extension.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def archive(packer, tmp_path_factory):
    wheels = sorted((ROOT / "build" / "wheel").glob(f"*-cp{sys.version_info[0]}{sys.version_info[1]}-*.whl"))
    if not wheels:
        pytest.skip("the wheel is not here: make blender-test builds it")
    return packer.make_extension(wheels, tmp_path_factory.mktemp("extension"))


def test_the_version_is_that_of_the_package():
    manifest = tomllib.loads((ROOT / "blender" / "blender_manifest.toml").read_text())
    assert manifest["version"] == voxrt.__version__


def test_blender_finds_nothing_wrong(packer, archive):
    checked = subprocess.run([*packer.validator(), str(archive)], capture_output=True, text=True, check=False)
    assert checked.returncode == 0, checked.stdout + checked.stderr


def test_the_archive_has_what_it_needs(packer, archive, tmp_path):
    with zipfile.ZipFile(archive) as opened:
        names = set(opened.namelist())
        manifest = tomllib.loads(opened.read("blender_manifest.toml").decode())
    assert tuple(map(int, manifest["blender_version_min"].split("."))) <= bpy.app.version
    assert bpy.app.version < tuple(map(int, manifest.get("blender_version_max", "9.0.0").split(".")))
    assert {"__init__.py", "blender_manifest.toml", "engine.py", "LICENSE"} <= names
    assert "make_extension.py" not in names
    assert {one.removeprefix("./") for one in manifest["wheels"]} == {one for one in names if one.endswith(".whl")}
    wheels = sorted((ROOT / "build" / "wheel").glob("*.whl"))
    assert packer.make_extension(wheels, tmp_path).read_bytes() == archive.read_bytes()


INSTALL = """
import sys, bpy
bpy.ops.extensions.package_install_files(filepath=sys.argv[1], repo="user_default", enable_on_install=True)
import voxrt
assert ".local" in voxrt.__file__, voxrt.__file__
assert "bl_ext.user_default.voxrt" in bpy.context.preferences.addons
scene = bpy.context.scene
scene.render.engine = "VOXRT"
scene.render.resolution_x, scene.render.resolution_y = 64, 48
scene.voxrt.depth = 5
bpy.ops.render.render()
print(bpy.ops.voxrt.build(), bpy.ops.voxrt.check())
bpy.ops.preferences.addon_disable(module="bl_ext.user_default.voxrt")
assert not hasattr(scene, "voxrt")
"""


def test_a_blender_without_voxrt_installs_and_runs_it(archive, tmp_path):
    """The startup scene, with its cube and its camera, is rendered by what the archive brings."""
    packages = tmp_path / "packages"
    packages.mkdir()
    for one in Path(sysconfig.get_paths()["platlib"]).iterdir():
        if not one.name.startswith("voxrt"):
            (packages / one.name).symlink_to(one)
    user = tmp_path / "user"
    user.mkdir()
    environment = os.environ | {"PYTHONPATH": str(packages), "BLENDER_USER_RESOURCES": str(user)}
    ran = subprocess.run(
        [sys.executable, "-S", "-P", "-c", INSTALL, str(archive)],
        capture_output=True,
        text=True,
        check=False,
        env=environment,
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr
    assert "{'FINISHED'} {'FINISHED'}" in ran.stdout
