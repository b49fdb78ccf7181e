"""The extension, as Blender loads it."""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).resolve().parents[2] / "blender"


@pytest.fixture(scope="session")
def package():
    """The extension's package; registered."""
    pytest.importorskip("bpy", reason="Blender's module bpy is not here: make blender-test")
    spec = importlib.util.spec_from_file_location(
        "voxrt_extension", FOLDER / "__init__.py", submodule_search_locations=[str(FOLDER)]
    )
    module = importlib.util.module_from_spec(spec)
    sys.modules["voxrt_extension"] = module
    spec.loader.exec_module(module)
    module.register()
    yield module
    module.unregister()


@pytest.fixture
def extension(package):
    """The extension's package in an empty file."""
    import blender_scenes as scenes

    scenes.empty_file()
    from voxrt_extension.memory import LATEST

    LATEST.results.clear()
    LATEST.animations.clear()
    return package
