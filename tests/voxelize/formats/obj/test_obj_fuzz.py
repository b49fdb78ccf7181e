"""OBJ and MTL texts of any kind: read or refused, and read as a plain reader of one line after another reads them."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from oracles.sound_scenes import read_or_refused

from voxrt.voxelize.formats.obj import load_obj

numbers = st.sampled_from(["0", "1", "-1", "2", "3", "1e3", "nan", "1e999", "-0", "x", "1.5.2", "+2", "1_0", ""])
corners = st.sampled_from(
    ["1", "2", "3", "4", "-1", "-3", "0", "9", "1/1", "2/2/1", "3//1", "1/", "/1", "1/x", "1//", "é"]
)
words = st.sampled_from(
    ["o", "g", "usemtl a", "usemtl", "mtllib m.mtl", "mtllib", "s 1", "l 1 2", "vn 0 0 1", "#", "\\", "fo"]
)
statements = st.one_of(
    st.lists(numbers, max_size=7).map(lambda row: "v " + " ".join(row)),
    st.lists(numbers, max_size=3).map(lambda row: "vt " + " ".join(row)),
    st.lists(corners, max_size=6).map(lambda row: "f " + " ".join(row)),
    st.just("v 1 0 0\nv 0 1 0\nv 0 0 1\nf -3 -2 -1"),
    words,
    st.text(max_size=12),
)
ends = st.sampled_from(["\n", "\r\n", "\r", " \\\n", "\n\n", " # note\n", ""])
texts = st.lists(st.tuples(statements, ends), max_size=30).map(lambda lines: "".join(a + b for a, b in lines))
materials = st.lists(
    st.sampled_from(
        [
            "newmtl a",
            "Kd 1 0 0",
            "Kd",
            "Kd x",
            "d 0.1",
            "Tr 1",
            "map_Kd m.mtl",
            "map_Kd -s 1 1 -o",
            "map_Kd -s",
            "illum 2",
        ]
    ),
    max_size=6,
).map("\n".join)


def load_text(folder, text, mtl=""):
    path = folder / "model.obj"
    path.write_bytes(text if isinstance(text, bytes) else text.encode("utf-8", "surrogatepass"))
    (folder / "m.mtl").write_text(mtl)
    scene = read_or_refused(load_obj, path)
    assert scene is None or all(len(one.mesh.triangles) for one in scene.objects)
    return scene


@given(texts, materials)
def test_any_statements(tmp_path_factory, text, mtl):
    load_text(tmp_path_factory.mktemp("obj"), text, mtl)


@given(st.binary(max_size=200))
def test_any_bytes(tmp_path_factory, data):
    load_text(tmp_path_factory.mktemp("obj"), data)
    load_text(tmp_path_factory.mktemp("obj"), b"v 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n" + data)


def plain_reader(text):
    """Positions and faces, one line after another; None where the text says something else."""
    positions, faces = [], []
    for line in text.split("\n"):
        fields = line.split("#")[0].split()
        if fields[:1] == ["v"]:
            positions.append([float(word) for word in fields[1:4]])
        elif fields[:1] == ["f"]:
            rows = [int(word.split("/")[0]) for word in fields[1:]]
            faces.append([row - 1 if row > 0 else len(positions) + row for row in rows])
    return np.array(positions), faces


good_vertices = st.tuples(*[st.floats(-100, 100, allow_nan=False, width=32)] * 3)


@st.composite
def good_files(draw):
    vertices = draw(st.lists(good_vertices, min_size=3, max_size=12))
    lines = []
    for written, vertex in enumerate(vertices, start=1):
        gap = draw(st.sampled_from(["", " ", "\t"]))
        lines.append(f"{gap}v {gap}" + " ".join(map(repr, vertex)) + draw(st.sampled_from(["", " 1 0.5 0", " # note"])))
        if written >= 3 and draw(st.booleans()):
            rows = draw(st.permutations(range(1, written + 1)))[:3]
            rows = [row if draw(st.booleans()) else row - written - 1 for row in rows]
            tails = [draw(st.sampled_from(["", "/1", "/1/2", "//3"])) for _ in rows]
            lines.append("f " + " ".join(f"{row}{tail}" for row, tail in zip(rows, tails, strict=True)))
        if draw(st.integers(0, 4)) == 0:
            lines.append(draw(st.sampled_from(["vn 0 0 1", "vt 0 0", "", "# v 1 2 3", "s off"])))
    lines.append("f 1 2 3")
    return "\n".join(lines)


@given(good_files())
def test_as_a_plain_reader(tmp_path_factory, text):
    scene = load_text(tmp_path_factory.mktemp("obj"), text)
    positions, faces = plain_reader(text)
    (one,) = scene.objects
    assert np.array_equal(one.mesh.positions[one.mesh.triangles], positions[np.array(faces)])
