"""What each face of a USD prim wears: a material's id, or paint."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from pxr import Usd, UsdShade

from voxrt.voxelize.colour.paint import Coat, Paint
from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.usd import primvars
from voxrt.voxelize.formats.usd.images import Images, laid_out
from voxrt.voxelize.formats.usd.looks import NO_LOOK, Look, display_srgb, read_look
from voxrt.voxelize.formats.usd.values import integers
from voxrt.voxelize.scene import DEFAULT_COLOUR

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.voxelize.colour.material_table import MaterialTable
    from voxrt.voxelize.formats.companions import Companions
    from voxrt.voxelize.formats.usd.geometry import Surface
    from voxrt.voxelize.notes import Notes


@dataclass(eq=False, slots=True)
class Materials:
    """The materials of one stage; each is read once."""

    path: Path
    companions: Companions
    table: MaterialTable
    notes: Notes
    time: Usd.TimeCode
    _images: Images = field(init=False)
    _looks: dict[str, Look] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._images = Images(self.path, self.companions, self.notes)

    def looks_of_faces(self, prim: Usd.Prim, surface: Surface) -> tuple[list[Look], NDArray[np.int32]]:
        """Find the looks of a prim, and which of them each of its faces has (int32, shape (F,); -1 for holes).

        Raises
        ------
        AssetError
            A face subset names faces that are none.
        """
        looks: dict[Look, int] = {}
        rows = np.full(surface.face_count, -1, dtype=np.int32)
        for subset in UsdShade.MaterialBindingAPI(prim).GetMaterialBindSubsets():
            indices = integers(subset.GetIndicesAttr(), self.time, self.path)
            if len(indices) and (indices.min() < 0 or indices.max() >= surface.face_count):
                problem = f"a face subset names faces beyond the mesh's {surface.face_count}"
                raise AssetError(self.path, problem, place=str(subset.GetPath()), fix="export the mesh again")
            material = self._direct(subset.GetPrim(), len(indices))
            if material is not None:
                rows[indices] = looks.setdefault(self._look(material), len(looks))
        left = np.unique(surface.faces[rows[surface.faces] < 0])
        if len(left):
            rows[left] = looks.setdefault(self._own_look(prim), len(looks))
        return list(looks), rows

    def wear(
        self, prim: Usd.Prim, surface: Surface, looks: list[Look], rows: NDArray[np.int32]
    ) -> tuple[NDArray[np.uint8], Coat | None]:
        """Dress a prim's triangles.

        Returns
        -------
        materials
            uint8, shape (T,): ids; 0 for air and for painted triangles.
        coat
            The paint, None where there is none.
        """
        by_triangle = rows[surface.faces]
        materials = np.zeros(len(by_triangle), dtype=np.uint8)
        painted = np.full(len(by_triangle), -1, dtype=np.int32)
        paints: list[Paint] = []
        uv = np.zeros((len(by_triangle), 3, 2))
        colours = np.ones((len(by_triangle), 3, 4), dtype=np.float32)
        for row, look in enumerate(looks):
            here = by_triangle == row
            faces = int((rows == row).sum())
            if look.alpha is None and look.opacity < look.cutoff:
                message = "faces of a material below its threshold of opacity (a half by default) were taken as air"
                self.notes.add("transparent", message, faces)
                continue
            if look.image is not None or look.alpha is not None:
                coordinates = self._textured(prim, surface, look, faces)
                if coordinates is not None:
                    paint, laid = coordinates
                    uv[here], painted[here] = laid[here], len(paints)
                    paints.append(paint)
                    continue
            if look.primvar is not None:
                tint = primvars.at_corners(prim, look.primvar, surface, self.time, self.notes)
                if tint is not None and tint.shape[2] >= 3:
                    colours[here, :, :3], painted[here] = np.clip(tint[here, :, :3], 0.0, 1.0), len(paints)
                    paints.append(Paint(look.name or look.primvar))
                    continue
            materials[here] = self._uniform(look, faces)
        coat = Coat(tuple(paints), painted, uv, colours) if paints else None
        return materials, coat

    def _own_look(self, prim: Usd.Prim) -> Look:
        """Return the look of the material bound to a prim, else of its displayColor."""
        api = UsdShade.MaterialBindingAPI(prim)
        for purpose in (UsdShade.Tokens.preview, UsdShade.Tokens.full):
            material = api.ComputeBoundMaterial(materialPurpose=purpose)[0]
            if material:
                return self._look(material)
        opacity = primvars.constant(prim, "displayOpacity", self.time)
        alpha = float(opacity[0]) if opacity is not None else 1.0
        colour = primvars.constant(prim, "displayColor", self.time)
        if colour is not None and len(colour) >= 3:
            linear = (float(colour[0]), float(colour[1]), float(colour[2]))
            red, green, blue = display_srgb(linear)
            return Look(f"#{red:02x}{green:02x}{blue:02x}", linear, alpha)
        if primvars.exists(prim, "displayColor", self.time):
            return Look("displayColor", None, alpha, primvar="displayColor")
        return NO_LOOK if alpha == 1.0 else Look(None, None, alpha)

    def _direct(self, prim: Usd.Prim, faces: int) -> UsdShade.Material | None:
        binding = UsdShade.MaterialBindingAPI(prim).GetDirectBinding()
        material = binding.GetMaterial()
        if material:
            return material
        if binding.GetMaterialPath():
            self.notes.add("missing-material", "bindings to materials that do not exist were ignored", faces)
        return None

    def _look(self, material: UsdShade.Material) -> Look:
        prim = material.GetPrim()
        path = str((prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim).GetPath())
        if path not in self._looks:
            self._looks[path] = read_look(material, self.time, self.notes)
        return self._looks[path]

    def _textured(
        self, prim: Usd.Prim, surface: Surface, look: Look, faces: int
    ) -> tuple[Paint, NDArray[np.float64]] | None:
        """Return the paint of a textured look, and coordinates (float64, shape (T, 3, 2)); None where it cannot be."""
        source = look.image or look.alpha
        assert source is not None
        texture = self._images.texture(look, faces)
        if texture is None:
            return None
        stored = primvars.at_corners(prim, source.primvar, surface, self.time, self.notes)
        if stored is None or stored.shape[2] < 2:
            if source.point is None:
                message = "textured faces without coordinates took the fallback of their texture or the default colour"
                self.notes.add("texture", message, faces)
                return None
            # UsdUVTexture reads its image at (0, 0) when nothing is connected to st (UsdPreviewSurface specification).
            message = "textured faces took one colour of their image, because no coordinates are connected to it"
            self.notes.add("texture", message, faces)
            stored = np.broadcast_to(np.array(source.point), (len(surface.triangles), 3, 2))
        plain = look.colour if look.image is None and look.colour else (1.0, 1.0, 1.0)
        opacity = 1.0 if look.alpha is not None else look.opacity
        cutoff = look.cutoff if look.alpha is not None else 0.0
        return Paint(look.name or "texture", (*plain, opacity), texture, cutoff), laid_out(stored, source)

    def _uniform(self, look: Look, faces: int) -> int:
        """Return the id of one colour. Each reference to a file brings copies of the file's materials: one name and
        colour are one material.
        """  # noqa: D205
        if look.name is None:
            return self.table.default(self.notes, faces)
        if look.colour is None:
            return self.table.id_of((look.name, DEFAULT_COLOUR), look.name, DEFAULT_COLOUR)
        colour = display_srgb(look.colour)
        return self.table.id_of((look.name, colour), look.name, colour)
