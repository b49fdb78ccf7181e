"""Small files that ask for memory or time by the square: they are refused, in one line, before either is spent."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from voxrt import voxelize
from voxrt.voxelize import AssetError, DoesNotFitError
from voxrt.voxelize.authoring.scene_toml.positions import longest_key

LIMITED = """
import resource, sys
from voxrt import voxelize
import voxrt.voxelize.authoring.scene_toml.load
import voxrt.voxelize.formats.obj.load
with open("/proc/self/statm") as file:
    used = int(file.read().split()[5]) * resource.getpagesize()
resource.setrlimit(resource.RLIMIT_DATA, (used + (256 << 20), used + (256 << 20)))
try:
    voxelize.load(sys.argv[1])
except (voxelize.AssetError, voxelize.DoesNotFitError) as error:
    print(error)
"""


def answer_of(path):
    """What reading a file says, in a process that may take a quarter of a gigabyte more."""
    done = subprocess.run([sys.executable, "-c", LIMITED, path], capture_output=True, text=True, check=True)
    (line,) = done.stdout.splitlines()
    return line


KEYS = {
    "bare": ("a." * 16_000 + "a=1", 16_001),
    "header": ("[" + "a." * 16_000 + "a]", 16_001),
    "headers of a list": ("[[" + "a." * 16_000 + "a]]", 16_001),
    "quoted": ('"a.b" . ' * 16_000 + "'c'=1", 16_001),
    "inline": ("a={" + "b." * 16_000 + "c=1}", 16_001),
    "after a string": ('a="""\n#\\"""" \n' + "b." * 16_000 + "c=1", 16_001),
}


@pytest.mark.skipif(sys.platform != "linux", reason="limits memory as Linux does")
@pytest.mark.parametrize("kind", KEYS)
def test_keys_of_many_parts(tmp_path, kind):
    text, parts = KEYS[kind]
    (tmp_path / "scene.toml").write_text(text)
    line = 3 if kind == "after a string" else 1
    assert f"line {line}: a key has {parts} parts; use 48 at most" in answer_of(tmp_path / "scene.toml")


@pytest.mark.parametrize(
    "text",
    [
        '# a.b.c.d\nx = "a.b.c.d"\ny = 1.5\n',
        'x = """a.b.c.d\n"quoted" a.b.c\\""" """\n',
        "x = '''a.b.c.d''' # a.b.c.d\n",
        "x = 'a.b.c'\ny = [1.5, 2.5]\n",
    ],
)
def test_strings_and_comments_are_no_keys(text):
    assert longest_key(text).parts <= 2


@given(st.text(alphabet="ab.\"'\\\n #=[]", max_size=60))
def test_any_text_has_a_longest_key(text):
    found = longest_key(text)
    assert found.parts <= text.count(".") + 1
    assert 1 <= found.line <= text.count("\n") + 1


@pytest.mark.parametrize("text", ['"""\\' * 50_000, "'''" + "''" * 50_000 + "'''", '"' * 200_001, "'\n" * 100_000])
def test_no_text_takes_long(text):
    """Each is one scan; a scan from every quote would take minutes."""
    assert longest_key(text).parts <= 100_000


def polygon(corners):
    angles = np.arange(corners) / corners * 2 * np.pi
    radii = 1 + 0.3 * (np.arange(corners) % 2)
    rows = [f"v {r * np.cos(a)} {r * np.sin(a)} 0" for r, a in zip(radii, angles, strict=True)]
    return "\n".join([*rows, "f " + " ".join(map(str, range(1, corners + 1)))])


def test_polygons_of_many_corners(tmp_path):
    path = tmp_path / "star.obj"
    path.write_text(polygon(70_000))
    with pytest.raises(DoesNotFitError, match=r"one has 70,000\); export it as triangles"):
        voxelize.load(path)
    path.write_text(polygon(3_000))
    assert len(voxelize.load(path).objects[0].mesh.triangles) == 2_998


def test_one_face_named_again_and_again(tmp_path):
    """Each of 4,000 equal triangles covers all of the world's cross-section."""
    path = tmp_path / "equal.obj"
    path.write_text("v 0 0 0\nv 64 0 0\nv 0 64 64\n" + "f 1 2 3\n" * 4_000)
    line = LIMITED.replace("voxelize.load(sys.argv[1])", "import voxrt; print(voxrt.build(sys.argv[1], depth=6).rom)")
    done = subprocess.run([sys.executable, "-c", line, path], capture_output=True, text=True, check=True)
    assert "depth 6" in done.stdout


def test_nested_values_are_one_line(tmp_path):
    for name, text in {
        "a.gltf": '{"asset": {"version": "2.0"}, "extras": ' + "[" * 100_000 + "]" * 100_000 + "}",
        "b.gltf": '{"a":' * 100_000,
        "c.toml": "a = " + "[" * 100_000,
        "d.toml": "a = " + "{a=" * 100_000,
    }.items():
        path = tmp_path / name
        path.write_text(text)
        with pytest.raises(AssetError) as caught:
            voxelize.load(path)
        assert "\n" not in str(caught.value)
