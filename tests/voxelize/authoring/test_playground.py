"""The example written by hand is the example written in Python."""

import sys
from pathlib import Path

import numpy as np

from voxrt.voxelize.assets import load

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"


def test_toml_and_python_say_the_same(monkeypatch):
    monkeypatch.syspath_prepend(str(EXAMPLES))
    playground = __import__("playground").playground
    sys.modules.pop("playground")
    written, made = load(EXAMPLES / "playground.toml"), playground()
    assert written.warnings == made.warnings == ()
    assert written.materials == made.materials
    assert (written.viewpoint, written.light) == (made.viewpoint, made.light)
    assert [one.name for one in written.objects] == [one.name for one in made.objects]
    for one, other in zip(written.objects, made.objects, strict=True):
        assert [type(collider) for collider in one.colliders] == [type(collider) for collider in other.colliders]
        for array in ("positions", "triangles", "materials"):
            assert np.allclose(getattr(one.mesh, array), getattr(other.mesh, array)), one.name
        assert np.allclose(one.transform, other.transform)
