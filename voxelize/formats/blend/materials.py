"""Materials of Blender: the colour, the opacity and the textures of their surface shader."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from msgspec import Struct

from voxrt.voxelize.formats.authored_properties import PREFIX, MaterialProperties, checked_properties
from voxrt.voxelize.formats.blend.nodes import Product, output_of, product, source, threshold
from voxrt.voxelize.formats.colour_range import clamped

if TYPE_CHECKING:
    from collections.abc import Callable

    from voxrt.voxelize.errors import AssetError
    from voxrt.voxelize.formats.blend.nodes import Groups, ImageUse, Socket
    from voxrt.voxelize.warning_log import WarningLog


class SurfaceMaterial(Struct, frozen=True, eq=False):
    """What a material says about the surface that has it."""

    key: object  # equal for materials that become one
    name: str
    factor: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)  # linear red, green, blue and alpha
    image: ImageUse | None = None
    opacity: ImageUse | None = None
    channel: str = "alpha"  # that of the opacity image
    attribute: str | None = None  # the colour attribute; empty for the active one
    cutoff: float = 0.0  # the surface is cut away where its alpha is below this; 0 for opaque surfaces
    mirror: bool = False
    authored: bool = True  # whether faces have it by their author's will


class Materials:
    """The materials of one scene, each read once."""

    def __init__(
        self, named: Any, log: WarningLog, error: Callable[[str, str, str], AssetError], opaque_from: float
    ) -> None:
        self._named = named  # the file's materials
        self._log = log
        self._error = error
        self._opaque_from = opaque_from
        self._read: dict[tuple[str, bool], SurfaceMaterial] = {}

    def of(self, material: Any, *, mirrored: bool = False) -> SurfaceMaterial:
        """Return what a material of a face says; None for a face without one. `mirrored` makes it a mirror."""
        if material is None:
            return SurfaceMaterial(("default", mirrored), "default", mirror=mirrored, authored=False)
        key = str(material.name_full), mirrored
        if key not in self._read:
            self._read[key] = self._surface(material, mirrored=mirrored)
        return self._read[key]

    def called(self, name: str, place: str) -> Any:
        """Return the material that an object's `voxrt_material` names; AssetError where there is none."""
        for one in self._named:
            if name in (one.name, one.get(f"{PREFIX}material")):
                return one
        known = ", ".join(repr(one.name) for one in self._named[:8]) or "no materials"
        raise self._error(place, f"no material {name!r} in the file", f"it has {known}")

    def _surface(self, material: Any, *, mirrored: bool) -> SurfaceMaterial:
        place = f"material {material.name!r}"
        authored = checked_properties(
            {key: material[key] for key in material.keys() if key.startswith(PREFIX)},  # noqa: SIM118 - not a dict
            MaterialProperties,
            place,
            self._error,
        )
        mirror = mirrored or bool(authored.voxrt_reflect)
        name = authored.voxrt_material or material.name
        key = (name, mirror) if authored.voxrt_material else (material.name_full, mirror, "own")
        colour, alpha, rounds = self._shown(material)
        red, green, blue = clamped(colour.factor, self._log).tolist()
        opacity = min(max(alpha.factor[0], 0.0), 1.0)
        image = alpha.image
        if alpha.attribute is not None and alpha.attribute != colour.attribute:
            self._log.add("alpha", "alphas by a colour attribute that is not the colour's were ignored")
            alpha = Product(alpha.factor, image)
        varies = image is not None or alpha.attribute is not None or opacity < 1
        cutoff = rounds if rounds is not None else self._opaque_from if varies else 0.0
        if colour.channel == "alpha":
            self._log.add("texture", "base colours that are an alpha were taken as the colour beside it")
        return SurfaceMaterial(
            key, name, (red, green, blue, opacity), colour.image, image, alpha.channel, colour.attribute, cutoff, mirror
        )

    def _shown(self, material: Any) -> tuple[Product, Product, float | None]:
        """Return the colour and the alpha of a material, and the alpha from which on it is solid, or None."""
        red, green, blue, alpha = material.diffuse_color
        plain = Product((red, green, blue)), Product((alpha, alpha, alpha)), None
        output = output_of(material)
        if output is None:
            return plain
        found = _surface_node(output.inputs["Surface"])
        if found is None:
            self._log.add("shader", "materials without a shader of one colour took their viewport colour")
            return Product((red, green, blue)), Product(), None
        node, groups, fraction = found
        rounds = None
        opacity: Product | None = Product()
        if node.type == "BSDF_TRANSPARENT":
            opacity = Product((0.0, 0.0, 0.0))
        elif fraction is not None:
            opacity, rounds = threshold(*fraction)
        elif "Alpha" in node.inputs:
            opacity, rounds = threshold(node.inputs["Alpha"], groups)
        if opacity is None:
            self._log.add("alpha", "materials whose alpha is computed by nodes are opaque")
            opacity = Product()
        colour = _colour(node, groups)
        if colour is None:
            self._log.add("shader", "materials whose colour is computed by nodes took their viewport colour")
            colour = Product((red, green, blue))
        return colour, opacity, rounds


def _surface_node(socket: Socket) -> tuple[Any, Groups, tuple[Socket, Groups] | None] | None:
    """Return the shader that gives a surface its colour, the groups around it, and what mixes it with transparency."""
    found = source(socket)
    if found is None:
        return None
    node, _, groups = found
    if node.type == "MIX_SHADER":
        clear, solid = (source(node.inputs[row], groups) for row in (1, 2))
        if clear is None or solid is None or clear[0].type != "BSDF_TRANSPARENT" or not _has_colour(solid[0]):
            return None
        return solid[0], solid[2], (node.inputs[0], groups)
    return (node, groups, None) if _has_colour(node) else None


def _has_colour(node: Any) -> bool:
    return hasattr(node, "inputs") and any(name in node.inputs for name in ("Base Color", "Color"))


def _colour(node: Any, groups: Groups) -> Product | None:
    """Return the colour that a shader reflects; what it emits where it reflects nothing, as in glTF."""
    if node.type == "EMISSION":
        return _emitted(node.inputs["Color"], node.inputs["Strength"], groups)
    colour = product(node.inputs["Base Color" if "Base Color" in node.inputs else "Color"], groups)
    if colour is not None and max(colour.factor) <= 0 and "Emission Color" in node.inputs:
        emitted = _emitted(node.inputs["Emission Color"], node.inputs["Emission Strength"], groups)
        if emitted is not None and max(emitted.factor) > 0:
            return emitted
    return colour


def _emitted(colour: Socket, strength: Socket, groups: Groups) -> Product | None:
    """Return a colour that is emitted, which may be brighter than white."""
    found, bright = product(colour, groups), product(strength, groups)
    if found is None or bright is None or bright.image or bright.attribute is not None:
        return None
    red, green, blue = (one * bright.factor[0] for one in found.factor)
    return Product((red, green, blue), found.image, found.attribute, found.channel)
