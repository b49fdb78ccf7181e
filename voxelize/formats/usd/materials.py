"""The appearance of each triangle of a USD prim: a material id, or a texture and vertex colours."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec import Struct, field
from pxr import Usd, UsdShade

from voxrt.voxelize.colour.appearance import Appearance, SurfaceAppearance
from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.colour_range import clamped
from voxrt.voxelize.formats.opacity import log_left_out
from voxrt.voxelize.formats.usd import primvars
from voxrt.voxelize.formats.usd.images import image_coordinates
from voxrt.voxelize.formats.usd.shading import NO_SHADING, Shading, clamped_colour, display_srgb, read_shading
from voxrt.voxelize.formats.usd.values import integers
from voxrt.voxelize.materials import DEFAULT_COLOUR

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.voxelize.formats.material_table import MaterialTable
    from voxrt.voxelize.formats.usd.geometry import Surface
    from voxrt.voxelize.formats.usd.images import Images
    from voxrt.voxelize.warning_log import WarningLog


class Materials(Struct, eq=False):
    """The materials of one stage; each is read once."""

    path: Path
    images: Images
    table: MaterialTable
    log: WarningLog
    time: Usd.TimeCode
    opaque_from: float  # faces of lower opacity are left out, unless their material has a threshold
    _shadings: dict[str, Shading] = field(default_factory=dict)

    def shadings_of_faces(self, prim: Usd.Prim, surface: Surface) -> tuple[list[Shading], NDArray[np.int32]]:
        """Return the shadings of a prim, and the one of each face as an index (int32, shape (F,); -1 for holes)."""
        shadings: dict[Shading, int] = {}
        rows = np.full(surface.face_count, -1, dtype=np.int32)
        for subset in UsdShade.MaterialBindingAPI(prim).GetMaterialBindSubsets():
            indices = integers(subset.GetIndicesAttr(), self.time, self.path)
            if len(indices) and (indices.min() < 0 or indices.max() >= surface.face_count):
                problem = f"a face subset refers to faces beyond the mesh's {surface.face_count}"
                raise AssetError(self.path, problem, place=str(subset.GetPath()), fix="export the mesh again")
            material = self._direct(subset.GetPrim(), len(indices))
            if material is not None:
                rows[indices] = shadings.setdefault(self._shading(material), len(shadings))
        left = np.unique(surface.faces[rows[surface.faces] < 0])
        if len(left):
            rows[left] = shadings.setdefault(self._own_shading(prim), len(shadings))
        return list(shadings), rows

    def assign(
        self, prim: Usd.Prim, surface: Surface, shadings: list[Shading], rows: NDArray[np.int32]
    ) -> tuple[NDArray[np.uint8], SurfaceAppearance | None]:
        """Return the materials and the appearance of a prim's triangles.

        The materials are uint8, shape (T,): ids; 0 for triangles that are left out, and for those with an appearance.
        The appearance is None where no triangle has textures or vertex colours.
        """
        by_triangle = rows[surface.faces]
        materials = np.zeros(len(by_triangle), dtype=np.uint8)
        entry_of = np.full(len(by_triangle), -1, dtype=np.int32)
        entries: list[Appearance] = []
        uv = np.zeros((len(by_triangle), 3, 2))
        colours = np.ones((len(by_triangle), 3, 4), dtype=np.float32)
        for row, shading in enumerate(shadings):
            here = by_triangle == row
            faces = int((rows == row).sum())
            cutoff = shading.threshold or self.opaque_from
            if shading.alpha is None and shading.opacity < cutoff:
                log_left_out(self.log, shading.opacity, cutoff, self.opaque_from, faces)
                continue
            if shading.image is not None or shading.alpha is not None:
                textured = self._textured(prim, surface, shading, faces)
                if textured is not None:
                    entry, uv_of_prim = textured
                    uv[here], entry_of[here] = uv_of_prim[here], len(entries)
                    entries.append(entry)
                    continue
            if shading.primvar is not None:
                corner_colours = primvars.at_corners(prim, shading.primvar, surface, self.time, self.log)
                if corner_colours is not None and corner_colours.shape[2] >= 3:
                    colours[here, :, :3] = clamped(corner_colours[here, :, :3], self.log)
                    entry_of[here] = len(entries)
                    entries.append(Appearance(shading.name or shading.primvar))
                    continue
            materials[here] = self._uniform(shading, faces)
        appearance = SurfaceAppearance(tuple(entries), entry_of, uv, colours) if entries else None
        return materials, appearance

    def _own_shading(self, prim: Usd.Prim) -> Shading:
        """Return the shading of the material that is bound to a prim, else of its displayColor."""
        api = UsdShade.MaterialBindingAPI(prim)
        for purpose in (UsdShade.Tokens.preview, UsdShade.Tokens.full):
            material = api.ComputeBoundMaterial(materialPurpose=purpose)[0]
            if material:
                return self._shading(material)
        opacity = primvars.constant(prim, "displayOpacity", self.time)
        alpha = float(opacity[0]) if opacity is not None else 1.0
        colour = primvars.constant(prim, "displayColor", self.time)
        if colour is not None and len(colour) >= 3:
            linear = clamped_colour((float(colour[0]), float(colour[1]), float(colour[2])), self.log)
            red, green, blue = display_srgb(linear)
            return Shading(f"#{red:02x}{green:02x}{blue:02x}", linear, alpha)
        if primvars.exists(prim, "displayColor", self.time):
            return Shading("displayColor", None, alpha, primvar="displayColor")
        return NO_SHADING if alpha == 1.0 else Shading(None, None, alpha)

    def _direct(self, prim: Usd.Prim, faces: int) -> UsdShade.Material | None:
        binding = UsdShade.MaterialBindingAPI(prim).GetDirectBinding()
        material = binding.GetMaterial()
        if material:
            return material
        if binding.GetMaterialPath():
            self.log.add("missing-material", "bindings to materials that do not exist were ignored", faces)
        return None

    def _shading(self, material: UsdShade.Material) -> Shading:
        prim = material.GetPrim()
        path = str((prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim).GetPath())
        if path not in self._shadings:
            self._shadings[path] = read_shading(material, self.time, self.log)
        return self._shadings[path]

    def _textured(
        self, prim: Usd.Prim, surface: Surface, shading: Shading, faces: int
    ) -> tuple[Appearance, NDArray[np.float64]] | None:
        """Return a texture's appearance and coordinates (float64, shape (T, 3, 2)); None where either is missing."""
        source = shading.image or shading.alpha
        assert source is not None
        texture = self.images.texture(shading, faces)
        if texture is None:
            return None
        stored = primvars.at_corners(prim, source.primvar, surface, self.time, self.log)
        if stored is None or stored.shape[2] < 2:
            if source.point is None:
                message = "textured faces without texture coordinates took the texture's fallback or the default colour"
                self.log.add("texture", message, faces)
                return None
            # UsdUVTexture reads its image at (0, 0) when nothing is connected to st (UsdPreviewSurface specification).
            message = "textured faces took one colour of their image: no texture coordinates are connected to it"
            self.log.add("texture", message, faces)
            stored = np.broadcast_to(np.array(source.point), (len(surface.triangles), 3, 2))
        elif source.point is not None:
            # By that specification they have one colour; that the mesh has coordinates says what the author meant.
            message = "textures without connected coordinates were placed by the coordinates 'st' of their meshes"
            self.log.add("texture", message, faces)
        plain = shading.colour if shading.image is None and shading.colour else (1.0, 1.0, 1.0)
        opacity = 1.0 if shading.alpha is not None else shading.opacity
        cutoff = 0.0 if shading.alpha is None else shading.threshold or self.opaque_from
        return Appearance(shading.name or "texture", (*plain, opacity), texture, cutoff), image_coordinates(
            stored, source
        )

    def _uniform(self, shading: Shading, faces: int) -> int:
        """Return the id of a uniform material.

        Each reference to a file brings copies of its materials; copies of one name and colour are one material.
        """
        if shading.name is None:
            return self.table.default(self.log, faces)
        if shading.colour is None:
            return self.table.id_of((shading.name, DEFAULT_COLOUR), shading.name, DEFAULT_COLOUR)
        colour = display_srgb(shading.colour)
        return self.table.id_of((shading.name, colour), shading.name, colour)
