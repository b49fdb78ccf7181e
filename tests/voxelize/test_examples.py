"""The examples in the docstrings of every module of the room run and give what they show."""

import doctest
import importlib
import pkgutil

import pytest

import voxrt.voxelize
from voxrt import voxelize
from voxrt.voxelize import authoring

WITHOUT_EXAMPLE = {
    "Collider": "a union of types",
    "DEFAULT_COLOUR": "a constant",
    "DEFAULT_COLOURS": "a constant",
    "EMPTY": "a constant",
    "MATERIAL_LIMIT": "a constant",
    "DoesNotFitError": "an exception without attributes",
    "ObjectReport": "voxelize() returns it and has the example",
    "Voxelization": "voxelize() returns it and has the example",
    "Voxels": "voxelize() returns it and has the example",
    "AuthoringError": "an exception without attributes",
    "Axis": "a type",
    "ColliderKind": "a type",
    "Colour": "a type",
    "SolidError": "an exception without attributes",
}

MODULES = sorted(
    module.name
    for module in pkgutil.walk_packages(voxrt.voxelize.__path__, "voxrt.voxelize.")
    if not module.name.endswith("._native")
)


@pytest.mark.parametrize("name", ["voxrt.voxelize", *MODULES])
def test_the_examples_of_a_module_run(name):
    try:
        module = importlib.import_module(name)
    except ModuleNotFoundError as missing:
        if missing.name != "bpy":
            raise
        pytest.skip("Blender's module bpy is not here: make blender-test")
    result = doctest.testmod(module)
    assert result.failed == 0


@pytest.mark.parametrize("package", [voxelize, authoring])
def test_every_public_name_has_an_example(package):
    without = {
        name
        for name in package.__all__
        if name not in WITHOUT_EXAMPLE and ">>>" not in (getattr(package, name).__doc__ or "")
    }
    assert not without
