"""``voxrt compare``: a memory held against its source."""

from __future__ import annotations

import sys

import msgspec
import pytest
from PIL import Image

from voxrt.cli.results.memory_results import CompareResult


@pytest.fixture
def built(voxrt, folder):
    assert voxrt("build", "house.obj", "--depth", "6").code == 0
    return folder


def test_a_memory_is_like_its_source(voxrt, built):
    pytest.importorskip("open3d", exc_type=ImportError, reason="Open3D is not installed")
    arguments = ("compare", "house.mem", "house.obj", "--size", "96x72")
    finished = voxrt.succeeds(*arguments, "--check", "-o", "like.png", "--json")
    result = msgspec.json.decode(finished.out, type=CompareResult, strict=True)
    assert result.silhouette_iou is not None
    assert result.silhouette_iou > 0.9
    assert result.depth_median is not None
    assert result.depth_median < 1
    assert result.outputs == {"picture": "like.png"}
    assert result.wrong_pixels == 0
    with Image.open(built / "like.png") as sheet:
        assert sheet.size == (4 * 96, 72)
    finished = voxrt(*arguments, "-o", "like.png")
    assert "silhouette" in finished.out
    assert "hardware" not in finished.out
    with Image.open(built / "like.png") as sheet:
        assert sheet.size == (3 * 96, 72)


def test_a_finer_grid_is_liker(voxrt, built):
    pytest.importorskip("open3d", exc_type=ImportError, reason="Open3D is not installed")
    finished = voxrt.succeeds("compare", "house.mem", "house.obj", "--size", "96x72", "--curve", "curve.png", "--json")
    curve = msgspec.json.decode(finished.out, type=CompareResult, strict=True).curve
    assert [point.depth for point in curve] == [3, 4, 5, 6]
    assert [point.words for point in curve] == sorted(point.words for point in curve)
    in_world = [point.depth_mean / (1 << point.depth) for point in curve if point.depth_mean]
    assert in_world == sorted(in_world, reverse=True)
    assert curve[0].silhouette_iou < curve[-1].silhouette_iou
    with Image.open(built / "curve.png") as drawn:
        assert drawn.width > 600


@pytest.mark.usefixtures("built")
def test_without_open3d(voxrt, monkeypatch):
    monkeypatch.setitem(sys.modules, "open3d", None)
    voxrt.fails(5, "pip install open3d", "compare", "house.mem", "house.obj")
