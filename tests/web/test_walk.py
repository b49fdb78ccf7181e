"""Walking on the static page: nobody is ever in a wall, falls, climbs steps and jumps as the body says."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from fakes.site import node

from voxrt.octree import from_dense

GAP = 1 / 1024


def words_of(dense: np.ndarray) -> dict[str, Any]:
    tree = from_dense(dense.astype(np.uint8))
    return {"words": tree.words.tolist(), "depth": tree.depth}


def overlaps(dense: np.ndarray, low: list[float], high: list[float]) -> bool:
    """Brute force: each voxel that has a part in the box."""
    first = np.clip(np.floor(low).astype(int), 0, dense.shape)
    end = np.clip(np.ceil(high).astype(int), 0, dense.shape)
    part = dense[tuple(slice(a, b) for a, b in zip(first, end, strict=True))]
    return bool(part.any())


def walked(dense: np.ndarray, place: list[float], wishes: list[dict], voxel_size: float = 1.0) -> dict[str, Any]:
    job = {**words_of(dense), "voxelSize": voxel_size, "place": place, "wishes": wishes}
    (found,) = node("walk.mjs", [job])
    assert "problem" not in found, found
    return found


def floor_with(*boxes: tuple[slice, slice, slice]) -> np.ndarray:
    dense = np.zeros((32, 32, 32), np.uint8)
    dense[:, :4] = 1
    for box in boxes:
        dense[box] = 1
    return dense


FORWARD = {"forward": 1, "yaw": np.pi / 2}  # along +x


def test_boxes_meet_what_is_solid_as_in_a_dense_grid() -> None:
    rng = np.random.default_rng(5)
    dense = (rng.random((16, 16, 16)) < 0.02).astype(np.uint8)
    dense[4:8, 0:4, 8:12] = 3
    low = rng.integers(-40, 300, (500, 3)) / 16
    high = low + rng.integers(1, 64, (500, 3)) / 16
    boxes = list(zip(low.tolist(), high.tolist(), strict=True))
    (found,) = node("walk.mjs", [{**words_of(dense), "boxes": boxes}])
    assert found == [overlaps(dense, *box) for box in boxes]
    assert 50 < sum(found) < 450


@pytest.mark.parametrize("voxel_size", [1.0, 0.3])
def test_nobody_is_ever_in_a_wall_or_leaves_the_world(voxel_size: float) -> None:
    rng = np.random.default_rng(round(10 * voxel_size))
    dense = (rng.random((32, 32, 32)) < 0.04).astype(np.uint8)
    dense[:, :3] = 1
    dense[8:20, 3:6, 8:20] = 2
    wishes = [
        {
            "forward": int(rng.integers(-1, 2)), "right": int(rng.integers(-1, 2)), "yaw": float(rng.random() * 6.3),
            "jump": bool(rng.random() < 0.2), "pace": 1.8, "seconds": float(rng.choice([1 / 60, 1 / 20, 0.1])),
        }
        for _ in range(1500)
    ]  # fmt: skip
    found = walked(dense, [16, 10, 16], wishes, voxel_size)
    places = np.array([one["place"] for one in found["steps"]])
    for one in found["steps"]:
        assert not overlaps(dense, *one["box"])
    assert places[:, [0, 2]].min() > 0
    assert places[:, [0, 2]].max() < 32
    assert places[:, 1].min() >= 3
    assert np.ptp(places[:, 0]) > 8  # it went somewhere
    assert any(one["stands"] for one in found["steps"])


def test_a_fall_takes_its_time_and_ends_on_the_ground() -> None:
    dense = floor_with()
    found = walked(dense, [16, 20, 16], [{}] * 120)
    heights = [one["place"][1] for one in found["steps"]]
    assert heights == sorted(heights, reverse=True)
    assert heights[-1] == pytest.approx(4 + GAP)
    landed = next(number for number, one in enumerate(found["steps"], 1) if one["stands"])
    assert landed / 60 == pytest.approx((2 * 16 / found["body"]["gravity"]) ** 0.5, abs=0.05)
    assert found["steps"][-1]["eye"][1] == pytest.approx(4 + found["body"]["eye"], abs=0.01)


def test_a_wall_stops_and_is_slid_along() -> None:
    dense = floor_with((slice(20, 24), slice(4, 12), slice(0, 32)))
    found = walked(dense, [16, 4, 16], [{}] * 5 + [{**FORWARD, "right": -1}] * 120)
    radius = found["body"]["radius"]
    x, _, z = found["steps"][-1]["place"]
    assert x == pytest.approx(20 - radius, abs=2 * GAP)
    assert abs(z - 16) > 3


@pytest.mark.parametrize(
    ("height", "jump", "climbs"), [(1, False, True), (2, False, False), (1, True, True), (2, True, False)]
)
def test_a_step_of_a_voxel_is_climbed(height: int, jump: bool, climbs: bool) -> None:
    dense = floor_with((slice(20, 32), slice(4, 4 + height), slice(0, 32)))
    found = walked(dense, [16, 4, 16], [{}] * 5 + [{**FORWARD, "jump": jump}] * 150)
    end = found["steps"][-1]["place"]
    assert (end[0] > 22) == climbs
    eyes = np.array([one["eye"][1] for one in found["steps"]])
    if climbs and not jump:
        assert end[1] == pytest.approx(4 + height + GAP, abs=2 * GAP)
        assert np.abs(np.diff(eyes[5:])).max() < 0.5  # the eye is up smoothly


def test_stairs_are_gone_down_without_a_fall() -> None:
    dense = floor_with(*((slice(0, 20 - step), slice(4, 5 + step), slice(0, 32)) for step in range(6)))
    found = walked(dense, [12, 10, 16], [{}] * 10 + [FORWARD] * 200)
    assert all(one["stands"] for one in found["steps"][10:])
    assert found["steps"][-1]["place"][1] == pytest.approx(4 + GAP, abs=2 * GAP)


def test_a_jump_is_as_high_as_the_body_says() -> None:
    found = walked(floor_with(), [16, 4, 16], [{}] * 5 + [{"jump": True}] + [{}] * 60)
    top = max(one["place"][1] for one in found["steps"])
    assert top - 4 == pytest.approx(found["body"]["jump"], rel=0.15)
    assert found["steps"][-1]["stands"]


@pytest.mark.parametrize("built_in", [True, False])
def test_whoever_is_in_something_solid_comes_out_above(built_in: bool) -> None:
    dense = floor_with((slice(15, 18), slice(4, 6), slice(15, 18)))
    job = {**words_of(dense), "voxelSize": 1.0, "place": [16.5, 4.5, 16.5], "wishes": [{}] * 200, "builtIn": built_in}
    (found,) = node("walk.mjs", [job])
    assert found["steps"][-1]["place"][1] == pytest.approx(6 + GAP, abs=2 * GAP)
