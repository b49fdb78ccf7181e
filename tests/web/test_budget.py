"""Budgets in the WebAssembly module: the words of ``voxrt build --budget``."""

from __future__ import annotations

import pytest
from fakes.site import ROOT, assert_same_memory, page_builds

import voxrt

DAYLIGHT = {"sun": [1, 3, 2], "sky": [0.4, 0.4, 0.4], "samples": 64}
CASES = [
    (["courtyard.glb"], 7, 3000, False),
    (["courtyard.glb"], 7, 100_000, False),
    (["planet.glb"], 7, 5000, False),
    (["house.obj", "house.mtl"], 6, 1500, False),
    (["house.obj", "house.mtl"], 6, 2500, True),
    (["planet.glb"], 5, 1200, True),
]


def build_in_node(files: list[str], depth: int, **options: object) -> dict:
    (found,) = page_builds([ROOT / "examples" / name for name in files], depth=depth, **options)
    return found


@pytest.mark.parametrize(("files", "depth", "words", "bake"), CASES)
def test_fitted_memories_have_the_words_of_the_native_module(
    files: list[str], depth: int, words: int, bake: bool
) -> None:
    native = voxrt.build(ROOT / "examples" / files[0], depth=depth, budget=words, bake=bake)
    found = build_in_node(files, depth, budget=words, bake=DAYLIGHT if bake else None)
    assert_same_memory(found, native.rom)
    fit, fitted = native.budget.fit, found["fitted"]
    assert (fitted["surface"], fitted["changed"], fitted["appeared"]) == (fit.surface, fit.changed, fit.appeared)
    assert fitted["wordsShared"] == fit.words_shared
    if bake:
        assert found["baked"]["colours"] == native.bake.colours


def test_a_budget_that_is_too_small_is_refused_as_natively() -> None:
    with pytest.raises(voxrt.voxelize.DoesNotFitError) as caught:
        voxrt.build(ROOT / "examples" / "courtyard.glb", depth=7, budget=20)
    assert build_in_node(["courtyard.glb"], 7, budget=20)["problem"] in str(caught.value)
    assert "budget must be" in build_in_node(["courtyard.glb"], 7, budget=0.5)["problem"]
