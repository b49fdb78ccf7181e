"""The hand-written stubs of the native modules name what the modules hold, no more and no less."""

import ast
import importlib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
STUBS = sorted(path.relative_to(ROOT) for path in ROOT.glob("*/_[!_]*.pyi"))


def public(names):
    return {name for name in names if not name.startswith("_")}


def stubbed(body):
    """Public names of a stub, classes with what they hold, without those that only a type checker knows."""
    names = {}
    for node in body:
        if isinstance(node, ast.ClassDef) and "TypedDict" not in map(ast.unparse, node.bases):
            names[node.name] = public(stubbed(node.body))
        elif isinstance(node, ast.FunctionDef):
            names[node.name] = None
        elif isinstance(node, ast.AnnAssign) and ast.unparse(node.annotation) != "TypeAlias":
            names[node.target.id] = None
    return names


@pytest.mark.parametrize("stub", STUBS, ids=str)
def test_a_stub_names_what_its_module_holds(stub):
    module = pytest.importorskip(f"voxrt.{stub.parent}.{stub.stem}")
    names = stubbed(ast.parse((ROOT / stub).read_text()).body)
    assert public(names) == public(vars(module))
    for name, members in names.items():
        if members is not None:
            assert members == public(vars(getattr(module, name))), name


def test_every_native_module_has_a_stub():
    assert {str(stub) for stub in STUBS} >= {"voxelize/_native.pyi", "octree/_native.pyi", "sim/_model.pyi"}
    assert importlib.import_module("voxrt.octree._native")
