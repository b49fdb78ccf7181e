"""Which colour a USD prim's faces have."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from pxr import Usd, UsdGeom, UsdShade

from voxrt.voxelize.colour import srgb_from_linear
from voxrt.voxelize.scene import DEFAULT_COLOUR

if TYPE_CHECKING:
    from voxrt.voxelize.material_table import MaterialTable
    from voxrt.voxelize.notes import Notes

OPAQUE_FROM = 0.5
"""A surface of lower opacity is air."""

# What shaders other than UsdPreviewSurface call their base colour.
_COLOUR_INPUTS = (
    "diffuseColor",
    "base_color",
    "baseColor",
    "diffuse_color_constant",
    "diffuse_reflection_color",
    "diffuse_color",
    "color",
)


@dataclass(eq=False, slots=True)
class Materials:
    """Material ids of prims, by bound material or displayColor."""

    table: MaterialTable
    notes: Notes
    time: Usd.TimeCode
    _ids: dict[str, int] = field(default_factory=dict)

    def of_prim(self, prim: Usd.Prim, faces: int) -> int:
        """Return the id of a prim's own binding, of its displayColor or of the default material; 0 for air.

        `faces` is how many faces depend on it, for the warnings.
        """
        bound = self._bound(prim)
        if bound is not None:
            return self._of_material(bound, faces)
        return self._of_display_colour(prim, faces)

    def of_subset(self, subset: UsdGeom.Subset, faces: int) -> int | None:
        """Return the id of a face subset's binding, None where it has none."""
        binding = UsdShade.MaterialBindingAPI(subset.GetPrim()).GetDirectBinding()
        material = binding.GetMaterial()
        if not material:
            if binding.GetMaterialPath():
                self.notes.add("missing-material", "bindings to materials that do not exist were ignored", faces)
            return None
        return self._of_material(material, faces)

    def _bound(self, prim: Usd.Prim) -> UsdShade.Material | None:
        api = UsdShade.MaterialBindingAPI(prim)
        for purpose in (UsdShade.Tokens.preview, UsdShade.Tokens.full):
            material = api.ComputeBoundMaterial(materialPurpose=purpose)[0]
            if material:
                return material
        return None

    def _of_material(self, material: UsdShade.Material, faces: int) -> int:
        prim = material.GetPrim()
        path = str((prim.GetPrimInPrototype() if prim.IsInstanceProxy() else prim).GetPath())
        if path not in self._ids:
            self._ids[path] = self._new(material, faces)
        number = self._ids[path]
        if number == 0:
            self.notes.add("transparent", f"faces of materials less opaque than {OPAQUE_FROM} were taken as air", faces)
        return number

    def _new(self, material: UsdShade.Material, faces: int) -> int:
        # Each reference to a file brings its own copy of the file's materials: one name and colour are one material.
        name = material.GetPrim().GetName()
        shader = _surface(material)
        if shader is None:
            self.notes.add("material-colour", "materials without a surface that is understood got the default colour")
            return self.table.id_of((name, DEFAULT_COLOUR), name, DEFAULT_COLOUR)
        opacity = self._constant(shader, ("opacity",), faces)
        if isinstance(opacity, float) and opacity < OPAQUE_FROM:
            return 0
        colour = self._constant(shader, _COLOUR_INPUTS, faces)
        if not isinstance(colour, tuple):
            if shader.GetIdAttr().Get() == "UsdPreviewSurface":
                colour = (0.18, 0.18, 0.18)  # the specification's fallback
            else:
                self.notes.add("material-colour", "materials whose shader has no colour got the default colour")
                return self.table.id_of((name, DEFAULT_COLOUR), name, DEFAULT_COLOUR)
        encoded = _encode(colour)
        return self.table.id_of((name, encoded), name, encoded)

    def _constant(
        self, shader: UsdShade.Shader, names: tuple[str, ...], faces: int
    ) -> float | tuple[float, float, float] | None:
        for name in names:
            source = shader.GetInput(name)
            if not source:
                continue
            for attribute in UsdShade.Utils.GetValueProducingAttributes(source):
                producer = UsdShade.Shader(attribute.GetPrim())
                if UsdShade.Output.IsOutput(attribute) or producer.GetPrim() != shader.GetPrim():
                    self.notes.add("texture", "textures are not honoured; their fallback colour stands in", faces)
                    fallback = producer.GetInput("fallback") if producer else None
                    value = fallback.Get(self.time) if fallback else None
                    return _plain(value)
                value = attribute.Get(self.time)
                if value is not None:
                    return _plain(value)
        return None

    def _of_display_colour(self, prim: Usd.Prim, faces: int) -> int:
        gprim = UsdGeom.Gprim(prim)
        opacities = UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance("primvars:displayOpacity")
        opacity = opacities.ComputeFlattened(self.time) if opacities and opacities.HasValue() else None
        if opacity is not None and len(opacity) and float(np.mean(opacity)) < OPAQUE_FROM:
            self.notes.add("transparent", f"faces of materials less opaque than {OPAQUE_FROM} were taken as air", faces)
            return 0
        if not gprim:
            return self.table.default(self.notes, faces)
        primvar = UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance("primvars:displayColor")
        value = primvar.Get(self.time) if primvar and primvar.HasValue() else None
        if value is None or not len(value):
            return self.table.default(self.notes, faces)
        colours = np.asarray(value, dtype=np.float64).reshape(-1, 3)
        if len(colours) > 1 and (colours != colours[0]).any():
            self.notes.add("vertex-colours", "a displayColor that varies is not honoured; its mean stands in", faces)
        red, green, blue = _encode(tuple(colours.mean(axis=0).tolist()))
        return self.table.id_of(
            ("displayColor", red, green, blue), f"#{red:02x}{green:02x}{blue:02x}", (red, green, blue)
        )


def _surface(material: UsdShade.Material) -> UsdShade.Shader | None:
    for context in ("", "mtlx", "mdl", "ri", "glslfx"):
        source = material.ComputeSurfaceSource(context)
        if source and source[0]:
            return source[0]
    return None


def _plain(value: object) -> float | tuple[float, float, float] | None:
    if isinstance(value, (int, float)):
        return float(value)
    try:
        numbers = [float(number) for number in value]  # type: ignore[attr-defined]
    except (TypeError, ValueError):
        return None
    return (numbers[0], numbers[1], numbers[2]) if len(numbers) >= 3 else None


def _encode(linear: tuple[float, ...]) -> tuple[int, int, int]:
    finite = np.nan_to_num(np.array(linear[:3]), nan=0.0, posinf=1.0, neginf=0.0)
    red, green, blue = (int(value) for value in srgb_from_linear(finite))
    return red, green, blue
