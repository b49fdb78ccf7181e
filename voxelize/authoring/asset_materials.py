"""The materials of one asset file in the scene that takes it in."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec.structs import replace

from voxrt.voxelize.authoring.declared_materials import AuthoringError

if TYPE_CHECKING:
    from voxrt.voxelize.authoring.declared_materials import DeclaredMaterials
    from voxrt.voxelize.mesh import Mesh
    from voxrt.voxelize.scene import Scene


class AssetMaterials:
    """Replaces an asset's materials by the scene's. Each gets its id when a face first uses it.

    `renamed` maps the asset's material names to those of the scene; `name` is what the scene calls the asset, for
    errors.
    """

    def __init__(self, declared: DeclaredMaterials, asset: Scene, renamed: dict[str, str], name: str) -> None:
        self._declared = declared
        self._asset = asset
        self._renamed = renamed
        self._ids: dict[int, int] = {}
        appearances = {
            entry.name
            for one in asset.objects
            if one.mesh.appearance is not None
            for entry in one.mesh.appearance.entries
        }
        known = {material.name for material in asset.materials[1:]} | appearances
        for one in renamed:
            if one not in known:
                has = ", ".join(map(repr, sorted(known)))
                raise AuthoringError(f"the asset of {name!r} has no material {one!r}; it has {has}")

    def id_of(self, old: int) -> int:
        """Return the scene's id of the asset's material `old`."""
        if old not in self._ids:
            material = self._asset.materials[old]
            target = self._target(material.name)
            self._ids[old] = (
                self._declared.adopt(material) if target is None else self._declared.complete(target, material)
            )
        return self._ids[old]

    def replaced(self, mesh: Mesh) -> Mesh:
        """Return a mesh of the asset with the scene's materials; a declared material replaces a texture, too."""
        appearance = mesh.appearance
        materials = np.zeros(len(mesh.materials), dtype=np.uint8)
        if appearance is not None:
            rows = appearance.rows.copy()
            for row, entry in enumerate(appearance.entries):
                target = self._target(entry.name)
                if target in self._declared.without_colour:
                    raise AuthoringError(
                        f"material {entry.name!r} has a texture or vertex colours: give {target!r} a colour"
                    )
                if target is not None:
                    materials[rows == row] = self._declared.id_of(target)
                    rows[rows == row] = -1
            appearance = replace(appearance, rows=rows) if (rows >= 0).any() else None
        for old in np.unique(mesh.materials[materials == 0]).tolist():
            materials[(mesh.materials == old) & (materials == 0)] = self.id_of(old)
        return replace(mesh, materials=materials, appearance=appearance)

    def _target(self, name: str) -> str | None:
        """Return the declared material that replaces one of the asset's; None where it keeps its own."""
        if name in self._renamed:
            return self._renamed[name]
        return name if self._declared.declares(name) else None
