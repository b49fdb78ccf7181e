"""The scene of a COLLADA file: an object per geometry that a node shows. pycollada reads the elements."""

from __future__ import annotations

import io
from collections import Counter
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.voxelize.errors import DAMAGED, AssetError
from voxrt.voxelize.formats.dae.geometry import Bound, read_geometry
from voxrt.voxelize.formats.dae.materials import Materials
from voxrt.voxelize.formats.external_files import ExternalFiles, asset_name, read_asset
from voxrt.voxelize.formats.material_table import MaterialTable
from voxrt.voxelize.formats.mesh_materials import assign_materials
from voxrt.voxelize.formats.opacity import OPAQUE_FROM, nothing_shown
from voxrt.voxelize.formats.scene_frame import scene_transform
from voxrt.voxelize.formats.xml_elements import need, xml_elements
from voxrt.voxelize.scene import Scene, SceneObject
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from voxrt.voxelize.assets import UpAxis

_UP_AXES: dict[str, UpAxis] = {"X_UP": "x", "Y_UP": "y", "Z_UP": "z"}
_MOST_NODES, _DEEPEST = 1_000_000, 256


def load_dae(path: str | Path, *, allow_outside: bool = False, opaque_from: float = OPAQUE_FROM) -> Scene:
    """Read a COLLADA file: an object per geometry and node, with the colours and textures of its materials.

    `allow_outside`: whether textures may stand outside the file's folder. `opaque_from`: faces of lower opacity are
    left out. AssetError where it cannot be read, or the extra ``cad`` is not installed.
    """
    path = Path(path)
    need(path, "lxml", "collada")
    data = read_asset(path)
    unit = 1.0
    up: UpAxis = "y"
    for element in xml_elements(path, data, "unit", "up_axis"):
        if element.tag.endswith("unit"):
            unit = _metres(path, element.get("meter") or "1")
        else:
            up = _UP_AXES.get((element.text or "").strip(), "y")
    try:
        return _scene(path, data, scene_transform(up, unit), allow_outside=allow_outside, opaque_from=opaque_from)
    except (AssetError, MemoryError):
        raise
    except (AttributeError, IndexError, KeyError, TypeError, ValueError, RecursionError) as error:
        problem = f"is not as COLLADA has it ({type(error).__name__}: {_line(error)})"
        raise AssetError(path, problem, fix=DAMAGED) from None


def _metres(path: Path, text: str) -> float:
    try:
        unit = float(text)
        scene_transform("y", unit)
    except ValueError:
        raise AssetError(path, f"has a unit of {text[:24]!r} metres", fix=DAMAGED) from None
    return unit


def _scene(path: Path, data: bytes, frame: NDArray[np.float64], *, allow_outside: bool, opaque_from: float) -> Scene:
    log, table = WarningLog(), MaterialTable()
    document = _document(path, data)
    why = "; ".join(_line(error) for error in document.errors[:1])
    log.add("not-read", f"elements were left out that cannot be read: {why}", len(document.errors))
    materials = Materials(path, ExternalFiles.of(path, allow_outside=allow_outside), log, opaque_from)
    placed = list(_placed(path, document, log)) if document.scene is not None else []
    keys = [
        (geometry.id, *((symbol, material.id, channel) for symbol, (material, channel) in bound.items()))
        for _, geometry, bound, _ in placed
    ]
    first = {key: (geometry, bound) for key, (_, geometry, bound, _) in zip(keys, placed, strict=True)}
    loaded = [read_geometry(geometry, bound, materials, table) for geometry, bound in first.values()]
    meshes = dict(zip(first, assign_materials(loaded, table, log, opaque_from), strict=True))
    names = [name for name, _, _, _ in placed]
    repeats, numbers = Counter(names), Counter[str]()
    objects = []
    for key, name, (_, _, _, transform) in zip(keys, names, placed, strict=True):
        own = name if repeats[name] == 1 else f"{name} [{numbers[name]}]"
        numbers[name] += 1
        if len(meshes[key].triangles):
            objects.append(SceneObject(own, meshes[key], frame @ transform))
    if not objects and why:
        raise AssetError(path, f"shows nothing that can be read: {why}", fix=DAMAGED)
    if not objects:
        raise nothing_shown(path, log.warnings())
    return Scene(asset_name(path), tuple(objects), table.materials(), log.warnings())


def _document(path: Path, data: bytes) -> Any:  # noqa: ANN401 - pycollada has no types
    collada = import_module("collada")
    try:
        return collada.Collada(io.BytesIO(data), ignore=[collada.DaeError])
    except MemoryError:
        raise
    except Exception as error:  # noqa: BLE001 - it raises whatever its parsers do
        raise AssetError(path, f"pycollada cannot read it ({type(error).__name__})", fix=DAMAGED) from None


def _line(error: BaseException) -> str:
    return " ".join(str(error).split())[:80]


def _placed(
    path: Path,
    document: Any,  # noqa: ANN401
    log: WarningLog,
) -> Iterator[tuple[str, Any, dict[str, Bound], NDArray[np.float64]]]:
    """Yield what the scene shows: a name, a geometry, what is bound to its symbols, where it stands (shape (4, 4))."""
    scene = import_module("collada.scene")
    waiting = [(node, np.eye(4), "", 0) for node in reversed(document.scene.nodes)]
    visited = 0
    while waiting:
        node, transform, name, level = waiting.pop()
        visited += 1
        if visited > _MOST_NODES or level > _DEEPEST:
            problem = f"shows more than {_MOST_NODES:,} nodes, or {_DEEPEST} levels of them"
            raise AssetError(path, problem, fix=DAMAGED)
        if isinstance(node, scene.Node):
            with np.errstate(over="ignore", invalid="ignore"):
                below = transform @ np.asarray(node.matrix, np.float64)
            if not np.isfinite(below).all():
                raise AssetError(path, "a transform is not finite", place=f"node {node.id}", fix=DAMAGED)
            called = getattr(node, "name", None) or node.id or name
            waiting += [(child, below, called, level + 1) for child in reversed(node.children)]
        elif isinstance(node, (scene.GeometryNode, scene.ControllerNode)):
            geometry = getattr(node, "geometry", None)
            if geometry is None:  # of a skin, or of a morph
                skin = node.controller
                geometry = getattr(skin, "geometry", None) or skin.source_geometry
                transform = np.asarray(getattr(skin, "bind_shape_matrix", np.eye(4)), np.float64)
                log.add("skin", "skins and morphs are shown as they were bound, without their pose")
            bound = {one.symbol or "": (one.target, _channel(one)) for one in node.materials}
            yield name or geometry.name or geometry.id, geometry, bound, transform


def _channel(bound: Any) -> str | None:  # noqa: ANN401
    """Return the set of texture coordinates that a node binds to the texture of a material's colour."""
    wanted = getattr(bound.target.effect.diffuse, "texcoord", None)
    return next((channel for name, _, channel in bound.inputs if name == wanted), None)
