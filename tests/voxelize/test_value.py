"""Values of the API are taken for frozen dataclasses by the functions of the standard library."""

import copy
import dataclasses
import importlib
import inspect
import pickle
import pprint
from typing import TYPE_CHECKING

import msgspec
import numpy as np
import pytest
from msgspec import Struct, structs

import voxrt
from voxrt.voxelize import Grid, Material, Mesh, PointLight, Scene, SceneObject
from voxrt.voxelize.value import Value

if TYPE_CHECKING:  # and only then, as in the packages
    from fractions import Fraction

PACKAGES = ["", ".voxelize", ".voxelize.authoring", ".octree", ".octree.camera", ".export", ".sim", ".view", ".board"]
PACKAGES += [".serve"]


def exported():
    """Return the structs that packages export."""
    modules = [importlib.import_module(f"voxrt{name}") for name in PACKAGES]
    found = {value for module in modules for name in dir(module) if isinstance(value := getattr(module, name), type)}
    return sorted((value for value in found if issubclass(value, Value)), key=lambda value: value.__qualname__)


@pytest.mark.parametrize("struct", exported(), ids=lambda struct: struct.__name__)
def test_a_value_has_the_fields_of_a_dataclass(struct):
    assert dataclasses.is_dataclass(struct)
    assert tuple(one.name for one in dataclasses.fields(struct)) == struct.__struct_fields__
    assert all(isinstance(one.type, str) for one in dataclasses.fields(struct))
    assert list(inspect.signature(struct).parameters) == list(struct.__struct_fields__)
    assert struct.__struct_config__.frozen


def test_exported_values_are_many():
    assert len(exported()) > 60


def a_scene():
    mesh = Mesh(np.eye(3), [[0, 1, 2]], [1])
    materials = (Material("empty", (0, 0, 0)), Material("red", (255, 0, 0), mirror=True))
    return Scene("one", (SceneObject("triangle", mesh),), materials, light=PointLight((1, 2, 3)))


def test_a_changed_copy_is_checked():
    grid = Grid(4, (0, 0, 0), 0.5)
    for replace in (dataclasses.replace, structs.replace):
        assert replace(grid, depth=5) == Grid(5, (0, 0, 0), 0.5)
        with pytest.raises(ValueError, match="depth"):
            replace(grid, depth=99)
        with pytest.raises(TypeError):
            replace(grid, size=4)
    with pytest.raises(AttributeError):
        grid.depth = 5
    assert (copy.copy(grid), pickle.loads(pickle.dumps(grid))) == (grid, grid)


def test_a_scene_is_a_dictionary_all_the_way_down():
    scene = a_scene()
    found = dataclasses.asdict(scene)
    assert found["materials"][1] == {"name": "red", "colour": (255, 0, 0), "mirror": True, "authored": True}
    assert found["light"] == {"position": (1.0, 2.0, 3.0)}
    assert np.array_equal(found["objects"][0]["mesh"]["positions"], np.eye(3))
    assert dataclasses.astuple(scene)[0] == "one"
    assert pprint.pformat(scene, width=10) == repr(scene)


def test_options_are_values():
    options = voxrt.BuildOptions(depth=6)
    assert dataclasses.replace(options, rule="half") == voxrt.BuildOptions(depth=6, rule="half")
    assert dataclasses.asdict(options)["depth"] == 6


def test_derived_values_have_the_fields_of_their_bases():
    class Plain(Value, frozen=True):
        first: "int"

    class Derived(Plain, frozen=True):
        second: "tuple[int, ...]" = ()
        third: "list[Fraction]" = msgspec.field(default_factory=list)

    class Keywords(Plain, frozen=True, kw_only=True):
        fourth: "Fraction"

    assert [one.name for one in dataclasses.fields(Derived)] == ["first", "second", "third"]
    assert str(inspect.signature(Derived)).startswith("(first: 'int', second: 'tuple[int, ...]' = (), third: 'list")
    assert str(inspect.signature(Keywords)) == "(first: 'int', *, fourth: 'Fraction') -> None"
    assert dataclasses.asdict(Derived(1)) == {"first": 1, "second": (), "third": []}
    assert not dataclasses.is_dataclass(Struct)
