"""The scene of a 3MF file: an object per mesh and place, by build items and components of all its model parts."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from voxrt.voxelize.errors import DAMAGED, AssetError
from voxrt.voxelize.formats.external_files import asset_name, read_asset
from voxrt.voxelize.formats.material_table import MaterialTable
from voxrt.voxelize.formats.mesh_materials import LoadedMesh, assign_materials
from voxrt.voxelize.formats.opacity import OPAQUE_FROM, nothing_shown
from voxrt.voxelize.formats.scene_frame import scene_transform
from voxrt.voxelize.formats.threemf.model import UNITS, Group, Model, read_model
from voxrt.voxelize.formats.threemf.package import Package
from voxrt.voxelize.formats.xml_elements import need
from voxrt.voxelize.from_arrays import appearance_of_corners
from voxrt.voxelize.scene import Scene, SceneObject
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from collections.abc import Iterator

    from voxrt.voxelize.formats.threemf.model import ModelObject, Placed

_MOST_OBJECTS = 100_000
_DEEPEST = 32
_OPAQUE = 255
_NO_COLOUR = (0, 0, 0, 0)


def load_3mf(path: str | Path, *, opaque_from: float = OPAQUE_FROM) -> Scene:
    """Read a 3MF file: an object per mesh that the build has, with components, colours and materials.

    `opaque_from`: faces of lower opacity are left out. AssetError where it cannot be read, or the package lxml is not
    installed.
    """
    path = Path(path)
    need(path, "lxml")
    return _Reader(Package.of(path, read_asset(path)), opaque_from).scene()


class _Reader:
    """Reads the parts of a package that its build needs, each once."""

    def __init__(self, package: Package, opaque_from: float) -> None:
        self._path = package.path
        self._package = package
        self._opaque_from = opaque_from
        self._models: dict[str, Model] = {}
        self._table = MaterialTable()
        self._log = WarningLog()
        self._has_colours = False
        self._placed = 0

    def scene(self) -> Scene:
        root = self._model(self._package.root)
        shown = [found for item in root.items for found in self._shown(item, 0)]
        if self._package.assigns_filaments():
            self._log.add("material-colour", "filaments that a slicer gave objects were not read, nor their colours")
        self._has_colours = any(len(self._of(one).groups) for one in shown)
        keys = list(dict.fromkeys((one.part, one.number) for one in shown))
        loaded = [self._loaded(*key) for key in keys]
        assigned = assign_materials(loaded, self._table, self._log, self._opaque_from)
        meshes = dict(zip(keys, assigned, strict=True))
        names = [one.name or self._of(one).name for one in shown]
        repeats, numbers = Counter(names), Counter[str]()
        frame = scene_transform("z", UNITS[root.unit])
        objects = []
        for one, name in zip(shown, names, strict=True):
            own = name if repeats[name] == 1 else f"{name} [{numbers[name]}]"
            numbers[name] += 1
            mesh = meshes[one.part, one.number]
            if len(mesh.triangles):
                objects.append(SceneObject(own, mesh, frame @ one.transform))
        if not objects:
            raise nothing_shown(self._path, self._log.warnings())
        return Scene(asset_name(self._path), tuple(objects), self._table.materials(), self._log.warnings())

    def _model(self, part: str) -> Model:
        if part not in self._models:
            if part not in self._package.names:
                raise AssetError(self._path, f"has no part {part[:60]!r}, which it shows", fix=DAMAGED)
            self._models[part] = read_model(self._package, part)
            root = self._models[self._package.root]
            if self._models[part].unit != root.unit:
                self._log.add("unit", f"parts in another unit than the root model were read in its unit, {root.unit}")
        return self._models[part]

    def _of(self, one: Placed) -> ModelObject:
        found = self._model(one.part).objects.get(one.number)
        if found is None:
            problem = f"shows the object {one.number[:20]!r}, which is not in it"
            raise AssetError(self._path, problem, place=one.part, fix=DAMAGED)
        return found

    def _shown(self, one: Placed, level: int) -> Iterator[Placed]:
        """Yield the meshes below an item or a component, where they stand."""
        if level > _DEEPEST:
            raise AssetError(self._path, f"has components more than {_DEEPEST} levels deep", fix=DAMAGED)
        self._placed += 1
        if self._placed > _MOST_OBJECTS:
            raise AssetError(self._path, f"shows more than {_MOST_OBJECTS:,} objects", fix="split the file")
        found = self._of(one)
        if len(found.triangles):
            yield one
        for component in found.components:
            with np.errstate(over="ignore", invalid="ignore"):
                placed = one.transform @ component.transform
            if not np.isfinite(placed).all():
                raise AssetError(self._path, "a transform is not finite", place=one.part, fix=DAMAGED)
            yield from self._shown(replace(component, transform=placed), level + 1)

    def _loaded(self, part: str, number: str) -> LoadedMesh:
        """Return a mesh with a material per triangle of a base material, and colours at the corners of others."""
        model = self._model(part)
        found = model.objects[number]
        count = len(found.triangles)
        painted = "triangles painted in a slicer got the colour of their object: the colours of filaments are not read"
        self._log.add("material-colour", painted, found.painted)
        materials = np.zeros(count, np.uint8)
        colours = np.full((count, 3, 4), _OPAQUE, np.uint8)
        coloured = np.zeros(count, np.bool_)
        for row, name in enumerate(found.groups):
            here = np.flatnonzero(found.properties[:, 0] == row)
            group = model.groups.get(name, Group([]))
            table = np.array([colour or _NO_COLOUR for colour in group.colours], np.uint8).reshape(-1, 4)
            is_known = np.array([colour is not None for colour in [*group.colours, None]])  # the last: beyond the table
            corners = found.properties[here, 1:]
            corners = np.where((corners >= 0) & (corners < len(table)), corners, len(table))
            valid = is_known[corners].all(axis=1)
            lost = "triangles with a texture, or a colour that the file lacks, got the default colour"
            self._log.add("material-colour", lost, int((~valid).sum()))
            here, corners = here[valid], corners[valid]
            if group.names is not None:
                corners = corners[:, :1].repeat(3, axis=1)
                opaque = table[corners[:, 0], 3] == _OPAQUE
                for material in np.unique(corners[opaque, 0]).tolist():
                    of_material = here[opaque & (corners[:, 0] == material)]
                    materials[of_material] = self._id_of(group, (part, name, material))
                here, corners = here[~opaque], corners[~opaque]
            colours[here], coloured[here] = table[corners], True
        bare = (materials == 0) & ~coloured
        if bare.any():
            without = int((found.properties[bare, 0] < 0).sum())
            materials[bare] = self._table.default(self._log if self._has_colours else None, without)
        appearance = None
        if coloured.any():
            appearance = appearance_of_corners(found.name, colours, self._opaque_from)
            appearance = replace(appearance, rows=np.where(coloured, appearance.rows, np.int32(-1)))
        return LoadedMesh(found.positions, found.triangles, materials, appearance)

    def _id_of(self, group: Group, key: tuple[str, str, int]) -> int:
        assert group.names is not None
        colour = group.colours[key[2]]
        assert colour is not None
        red, green, blue, _ = colour
        return self._table.id_of((group.names[key[2]], red, green, blue), group.names[key[2]], (red, green, blue))
