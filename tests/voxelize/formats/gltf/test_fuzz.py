"""Damaged files: whatever is done to them, they load or are refused in one line; nothing else is raised."""

import copy
import json
import struct

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from oracles.gltf_writer import glb_of
from oracles.rich_gltf import rich
from oracles.sound_scenes import read_or_refused

from voxrt.voxelize import load

RICH = rich()


def paths(value, here=()):
    """Every place in a JSON value."""
    yield here
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from paths(inner, (*here, key))
    elif isinstance(value, list):
        for at, inner in enumerate(value):
            yield from paths(inner, (*here, at))


PLACES = [place for place in paths(RICH.json) if place]

odd_values = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-2, 9),
    st.sampled_from(
        [2**31, 2**32 - 1, 2**63, 2**64, -(2**63), 10**30, 5120, 5121, 5123, 5125, 5126, 1e308, -1e-320, 1e39]
    ),
    st.floats(allow_nan=False, allow_infinity=False),
    st.text(max_size=3),
    st.sampled_from(
        ["VEC3", "SCALAR", "MAT4", "BLEND", "CUBICSPLINE", "data:,", "../x", "POSITION", "rotation", "weights"]
    ),
    st.lists(st.integers(0, 4), max_size=4),
    st.dictionaries(
        st.sampled_from(["index", "shape", "bufferView", "POSITION", "type"]), st.integers(0, 9), max_size=2
    ),
)


def changed(document, place, value, remove):
    inner = document
    for step in place[:-1]:
        known = inner if isinstance(inner, dict) else range(len(inner)) if isinstance(inner, list) else ()
        if step not in known:
            return
        inner = inner[step]
    if isinstance(inner, dict):
        inner.pop(place[-1], None) if remove else inner.__setitem__(place[-1], value)
    elif isinstance(inner, list) and isinstance(place[-1], int) and place[-1] < len(inner):
        if remove:
            del inner[place[-1]]
        else:
            inner[place[-1]] = value


OPTIONS = st.sampled_from([{}, {"time": 0.5}, {"variants": ("v",)}])
FUZZ = settings(max_examples=250, deadline=None, suppress_health_check=[HealthCheck.too_slow])


def test_the_undamaged_file_loads(tmp_path):
    path = RICH.save(tmp_path / "rich.glb")
    for options in ({}, {"time": 0.5}, {"variants": ("v",)}):
        assert len(load(path, **options).objects) == 4


@FUZZ
@given(
    changes=st.lists(st.tuples(st.sampled_from(PLACES), odd_values, st.booleans()), min_size=1, max_size=3),
    options=OPTIONS,
)
def test_changed_json(changes, options, tmp_path_factory):
    document = copy.deepcopy(RICH.json)
    for place, value, remove in changes:
        changed(document, place, value, remove)
    path = tmp_path_factory.getbasetemp() / "changed.glb"
    path.write_bytes(glb_of(json.dumps(document).encode(), RICH.data))
    read_or_refused(load, path, **options)


@FUZZ
@given(
    changes=st.lists(st.tuples(st.integers(0, len(RICH.data) - 1), st.integers(0, 255)), min_size=1, max_size=8),
    options=OPTIONS,
)
def test_changed_binary(changes, options, tmp_path_factory):
    data = bytearray(RICH.data)
    for at, byte in changes:
        data[at] = byte
    path = tmp_path_factory.getbasetemp() / "bytes.glb"
    path.write_bytes(glb_of(json.dumps(RICH.json).encode(), data))
    read_or_refused(load, path, **options)


@settings(max_examples=100, deadline=None)
@given(cut=st.integers(0, 4000), garbage=st.binary(max_size=16), whole=st.booleans())
def test_cut_files(cut, garbage, whole, tmp_path_factory):
    data = glb_of(json.dumps(RICH.json).encode(), RICH.data)[:cut] + garbage
    if whole and len(data) > 12:
        data = data[:8] + struct.pack("<I", len(data)) + data[12:]
    path = tmp_path_factory.getbasetemp() / "cut.glb"
    path.write_bytes(data)
    read_or_refused(load, path)
