"""Loading ``scene.toml``."""

from __future__ import annotations

from functools import reduce
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.voxelize.assets import load
from voxrt.voxelize.authoring import solid as solids
from voxrt.voxelize.authoring.author import Author
from voxrt.voxelize.authoring.scene_toml.schema import SHAPES, Asset, Box, Node
from voxrt.voxelize.authoring.scene_toml.validation import CheckedFile, check_file
from voxrt.voxelize.authoring.solid import Solid
from voxrt.voxelize.authoring.transforms import placement
from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.external_files import ALLOW_OUTSIDE, ExternalFiles, asset_name, read_asset

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.authoring.scene_toml.positions import Path as KeyPath
    from voxrt.voxelize.scene import Scene


def load_scene_toml(
    path: str | Path, *, allow_outside: bool = False, opaque_from: float | None = None, points: int | None = None
) -> Scene:
    """Read a scene file and the assets that it names.

    Parameters
    ----------
    path
        The file. Paths of assets are relative to its folder.
    allow_outside
        Whether assets may stand outside that folder, and files that assets name outside theirs.
    opaque_from, points
        As :func:`voxrt.voxelize.load` takes them, for assets.

    Returns
    -------
    Scene
        Materials in the order of the file, whether used or not, then those of assets.

    Raises
    ------
    AssetError
        The file or an asset cannot be read, or asks for something that is not supported.
    DoesNotFitError
        More than 255 materials.
    """
    path = Path(path)
    try:
        text = read_asset(path).decode("utf-8-sig")  # some editors begin a file with a mark
    except UnicodeDecodeError:
        raise AssetError(path, "is not UTF-8 text", fix="save it as UTF-8") from None
    for_assets: dict[str, Any] = {"opaque_from": opaque_from, "points": points}
    return _Builder(check_file(path, text), for_assets, allow_outside=allow_outside).scene()


class _Builder:
    def __init__(self, checked: CheckedFile, for_assets: dict[str, Any], *, allow_outside: bool) -> None:
        self._for_assets = for_assets
        self._checked = checked
        self._external_files = ExternalFiles.of(checked.path, allow_outside=allow_outside)
        self._assets: dict[tuple[object, ...], Scene] = {}
        self._names: set[str] = set()

    def scene(self) -> Scene:
        checked, values = self._checked, self._checked.values
        try:
            self._author = Author(asset_name(checked.path), background=values.background)
        except ValueError as error:
            raise checked.error(("background",), str(error), "correct the colour") from None
        for name, material in values.materials.items():
            try:
                self._author.material(name, material.colour, mirror=material.mirror, number=material.id)
            except ValueError as error:
                raise checked.error(("materials", name), str(error), "correct the material") from None
        for index, node in enumerate(values.objects):
            self._add(node, ("objects", index), "", np.eye(4), None)
        for name in self._author.without_colour:
            problem = f"material {name!r} has no colour, and no asset has a material of that name"
            raise checked.error(("materials", name), problem, "give it a colour")
        if values.camera is not None:
            camera = values.camera
            try:
                self._author.look(camera.eye, camera.target, field_of_view=camera.field_of_view)
            except ValueError as error:
                raise checked.error(("camera",), str(error), "correct the camera") from None
        if values.light is not None:
            try:
                self._author.light(values.light.position)
            except ValueError as error:
                raise checked.error(("light",), str(error), "correct the light") from None
        return self._author.build()

    def _add(self, node: Node, where: KeyPath, prefix: str, outer: NDArray[np.float64], material: str | None) -> None:
        """Add the objects of a node: one, or those of a group or an asset."""
        shape = _shape(node)
        name = self._unique(prefix + (node.name or f"{shape} {int(where[-1]) + 1}"))
        material = node.material or material
        if node.group is not None:
            for key in ("collider", "rule", "fill"):
                if getattr(node, key) is not None:
                    raise self._checked.error((*where, key), f"a group cannot have a {key}", "put it on its objects")
            for index, one in enumerate(node.group):
                self._add(one, (*where, "group", index), f"{name}/", outer @ self._place(node, where), material)
            return
        try:
            transform = outer @ self._place(node, where)
            if node.asset is not None:
                if node.material is not None:
                    problem = "an asset cannot have a material"
                    raise self._checked.error((*where, "material"), problem, "rename them under asset.materials")
                self._author.add_asset(
                    name,
                    self._asset(node.asset, (*where, "asset")),
                    transform,
                    materials=node.asset.materials,
                    collider=node.collider,
                    pow2=node.pow2,
                    rule=node.rule,
                    fill=node.fill,
                )
                return
            self._author.add_transformed(
                name,
                self._unplaced(node, where),
                transform,
                material=material,
                collider=node.collider,
                pow2=node.pow2,
                rule=node.rule,
                fill=node.fill,
            )
        except ValueError as error:
            raise self._checked.error((*where, shape), str(error), "correct the object") from None

    def _unique(self, name: str) -> str:
        """Return a name, with a number and a warning where another object has it."""
        unique, number = name, 2
        while unique in self._names:
            unique, number = f"{name} ({number})", number + 1
        self._names.add(unique)
        if unique != name:
            self._author.warn("duplicate-name", f"several objects are named {name!r}: the later ones got a number")
        return unique

    def _solid(self, node: Node, where: KeyPath) -> Solid:
        """Return a node as an operand of a boolean, in its parent's frame."""
        made = self._unplaced(node, where)
        if node.material is not None:
            made = made.of(node.material)
        return made.transformed(self._place(node, where))

    def _place(self, node: Node, where: KeyPath) -> NDArray[np.float64]:
        try:
            return placement(node.translate, node.rotate, node.scale)
        except ValueError as error:
            raise self._checked.error((*where, "scale"), str(error), "correct the scale") from None

    def _unplaced(self, node: Node, where: KeyPath) -> Solid:
        """Return a node's shape in its own frame."""
        made = _primitive(node)
        if made is not None:
            return made
        if node.box is not None:
            return self._box(node.box, (*where, "box"))
        if node.asset is not None:
            return self._closed_asset(node.asset, (*where, "asset"))
        return self._combined(node, where)

    def _combined(self, node: Node, where: KeyPath) -> Solid:
        shape = _shape(node)
        if shape == "group":
            raise self._checked.error((*where, "group"), "a group is not a solid", "use union")
        for index, one in enumerate(getattr(node, shape)):
            for key in ("collider", "name", "rule", "fill"):
                if getattr(one, key) is not None:
                    problem = f"a part of a {shape} cannot have a {key}"
                    raise self._checked.error((*where, shape, index, key), problem, "put it on the whole")
        parts = [self._solid(one, (*where, shape, index)) for index, one in enumerate(getattr(node, shape))]
        if shape == "union":
            return reduce(Solid.__or__, parts)
        if shape == "difference":
            return reduce(Solid.__sub__, parts)
        if shape == "intersection":
            return reduce(Solid.__and__, parts)
        return solids.hull(parts)

    def _box(self, box: Box, where: KeyPath) -> Solid:
        if box.corner is not None and box.centre is not None:
            raise self._checked.error((*where, "corner"), "a box cannot have both a centre and a corner", "remove one")
        centre = box.centre or (0, 0, 0)
        if box.corner is not None:
            low = np.asarray(box.corner, dtype=np.float64)
            # Both corners are exact, so that neighbours touch without a gap.
            return solids.box_between(low, low + np.asarray(box.size, dtype=np.float64))
        return solids.box(box.size, centre=centre)

    def _closed_asset(self, asset: Asset, where: KeyPath) -> Solid:
        scene = self._asset(asset, where)
        parts = []
        for one in scene.objects:
            try:
                parts.append(solids.closed(one.mesh.positions, one.mesh.triangles).transformed(one.transform))
            except ValueError as error:
                raise self._checked.error(
                    (*where, "file"),
                    f"{one.name!r}: {error}",
                    "close its surface, or use the asset outside of booleans",
                ) from None
        return reduce(Solid.__or__, parts)

    def _asset(self, asset: Asset, where: KeyPath) -> Scene:
        key = (asset.file, asset.up, asset.unit, asset.time, asset.animation, tuple(asset.variants))
        if key not in self._assets:
            path = self._checked.path.parent / asset.file
            if path.suffix.lower() == ".toml":
                raise self._checked.error(
                    (*where, "file"), "a scene file cannot be an asset of another", "copy its objects"
                )
            if self._external_files.is_outside(asset.file):
                problem = f"asset {asset.file[:60]!r} is outside the scene file's folder"
                raise self._checked.error((*where, "file"), problem, ALLOW_OUTSIDE)
            try:
                self._assets[key] = load(
                    path,
                    up=asset.up,
                    unit=asset.unit,
                    time=asset.time,
                    animation=asset.animation,
                    variants=tuple(asset.variants),
                    allow_outside=self._external_files.allow_outside,
                    **self._for_assets,
                )
            except AssetError as error:
                if error.place:
                    raise
                raise self._checked.error((*where, "file"), f"asset {error}") from None
        return self._assets[key]


def _primitive(node: Node) -> Solid | None:
    if (ball := node.sphere) is not None:
        return solids.sphere(ball.radius, centre=ball.centre)
    if (tube := node.cylinder) is not None:
        return solids.cylinder(tube.radius, tube.height, axis=tube.axis, centre=tube.centre)
    if (tip := node.cone) is not None:
        return solids.cone(tip.radius, tip.height, axis=tip.axis, centre=tip.centre)
    if (prism := node.extrude) is not None:
        return solids.extrude(prism.outline, prism.height, axis=prism.axis)
    return None


def _shape(node: Node) -> str:
    return next(key for key in SHAPES if getattr(node, key) is not None)
