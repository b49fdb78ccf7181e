"""The colour properties of a USD material or displayColor."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from msgspec import Struct
from msgspec.structs import replace
from pxr import Sdf, Usd, UsdShade

from voxrt.voxelize.colour.srgb import srgb_from_linear
from voxrt.voxelize.formats.colour_range import clamped
from voxrt.voxelize.formats.usd.values import numbers

if TYPE_CHECKING:
    from voxrt.voxelize.colour.texture import Wrap
    from voxrt.voxelize.warning_log import WarningLog

Linear: TypeAlias = tuple[float, float, float]

_FALLBACK_DIFFUSE: Linear = (0.18, 0.18, 0.18)  # UsdPreviewSurface's own

# Names of the base colour, of UsdPreviewSurface and other shaders.
_COLOUR_INPUTS = (
    *("diffuseColor", "base_color", "baseColor", "diffuse_color_constant", "diffuse_reflection_color"),
    *("diffuse_color", "color"),
)
_EMISSION_INPUTS = ("emissiveColor", "emission_color", "emission", "emissive_color")
_CONTEXTS = ("", "mtlx", "mdl", "ri", "glslfx")
_WRAPS: dict[str, Wrap] = {"repeat": "repeat", "mirror": "mirror", "clamp": "clamp", "black": "clamp"}


class ImageSource(Struct, frozen=True):
    """A texture: its image and its placement on the surface."""

    file: str  # its path, there or not; empty for none
    raw: bool = False  # whether its colours are linear instead of sRGB
    wrap: tuple[Wrap, Wrap] = ("repeat", "repeat")  # how coordinates outside 0 … 1 are treated
    primvar: str = "st"  # the name of the primvar with the texture coordinates
    # Applied to the coordinates: scale, then rotation (degrees counter-clockwise), then offset.
    turn: float = 0.0
    scale: tuple[float, float] = (1.0, 1.0)
    offset: tuple[float, float] = (0.0, 0.0)
    # Applied to its linear colour and alpha.
    factor: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    bias: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    channel: str = "a"  # the channel, one of ``rgba``, that gives an opacity
    # The coordinates of every point, where no coordinates are connected; None where some are connected.
    point: tuple[float, float] | None = None


class Shading(Struct, frozen=True):
    """The colour and opacity of faces."""

    name: str | None  # the author's name; None for faces without any colour
    colour: Linear | None = None  # linear; used where a texture or primvar is missing. None where the author gave none.
    opacity: float = 1.0  # 0 … 1
    threshold: float = 0.0  # faces are cut away where their opacity is below it; 0 where the author gave none
    image: ImageSource | None = None  # a texture for the colour
    alpha: ImageSource | None = None  # a texture for the opacity
    primvar: str | None = None  # the name of the primvar that gives the colour


NO_SHADING = Shading(None)


def read_shading(material: UsdShade.Material, time: Usd.TimeCode, log: WarningLog) -> Shading:
    """Read a material's surface."""
    name = material.GetPrim().GetName()
    shader = next((found for one in _CONTEXTS if (found := material.ComputeSurfaceSource(one)[0])), None)
    if shader is None:
        log.add("material-colour", "materials without a supported surface shader got the default colour")
        return Shading(name)
    threshold = _input(shader, ("opacityThreshold",), time, log)
    opacity = _input(shader, ("opacity",), time, log)
    colour = _input(shader, _COLOUR_INPUTS, time, log)
    if colour is not None and colour.is_black():
        emitted = _input(shader, _EMISSION_INPUTS, time, log)
        colour = emitted if emitted and not emitted.is_black() else colour  # what reflects nothing shows what it emits
    plain = clamped_colour(colour.value, log) if colour and colour.value else None
    is_preview = shader.GetIdAttr().Get() == "UsdPreviewSurface"
    if plain is None and colour is not None and colour.image is None and colour.primvar is None and is_preview:
        plain = _FALLBACK_DIFFUSE
    if colour is None:
        plain = _FALLBACK_DIFFUSE if is_preview else None
        if not is_preview:
            log.add("material-colour", "materials whose shader has no colour got the default colour")
    return Shading(
        name,
        plain,
        opacity.value[0] if opacity and opacity.value else 1.0,
        threshold.value[0] if threshold and threshold.value else 0.0,
        colour.image if colour else None,
        opacity.image if opacity else None,
        colour.primvar if colour else None,
    )


def clamped_colour(colour: Linear, log: WarningLog) -> Linear:
    """Return a colour within 0 … 1, as :func:`~voxrt.voxelize.formats.colour_range.clamped` does."""
    red, green, blue = clamped(colour, log).tolist()
    return red, green, blue


def display_srgb(colour: Linear) -> tuple[int, int, int]:
    """Return a linear colour as sRGB, 0 … 255."""
    red, green, blue = srgb_from_linear(colour).tolist()
    return red, green, blue


class _Input(Struct, frozen=True):
    """The source of a shader's input: a value, a texture, or a primvar."""

    value: Linear | None = None
    image: ImageSource | None = None
    primvar: str | None = None

    def is_black(self) -> bool:
        """Tell whether it is one colour that reflects nothing."""
        return self.image is None and self.primvar is None and self.value is not None and max(self.value) <= 0


def _input(shader: UsdShade.Shader, names: tuple[str, ...], time: Usd.TimeCode, log: WarningLog) -> _Input | None:
    for name in names:
        source = shader.GetInput(name)
        if not source:
            continue
        for attribute in UsdShade.Utils.GetValueProducingAttributes(source):
            if UsdShade.Output.IsOutput(attribute):
                return _network(UsdShade.Shader(attribute.GetPrim()), attribute.GetBaseName(), time, log)
            value = _colour(attribute.Get(time))
            if value is not None:
                return _Input(value)
    return None


def _network(node: UsdShade.Shader, output: str, time: Usd.TimeCode, log: WarningLog) -> _Input:
    kind = str(node.GetIdAttr().Get()) if node else ""
    if kind == "UsdUVTexture":
        fallback = _colour(_value(node, "fallback", time))
        return _Input(fallback, replace(_image_source(node, time, log), channel=output))
    if kind.startswith("UsdPrimvarReader_float3"):
        return _Input(_colour(_value(node, "fallback", time)), primvar=str(_value(node, "varname", time) or ""))
    log.add("shader", f"shader nodes {kind or 'without an id'} are not supported; the default colour was used")
    return _Input()


def _image_source(node: UsdShade.Shader, time: Usd.TimeCode, log: WarningLog) -> ImageSource:
    wrap_s, wrap_t = (str(_value(node, name, time) or "repeat") for name in ("wrapS", "wrapT"))
    if "black" in (wrap_s, wrap_t):
        log.add("texture", "textures that are black beyond their edges were continued with their edges' colours")
    primvar, turn, scale, offset = _coordinates(node, time, log)
    connected = _upstream(node, "st") is not None
    return ImageSource(
        file=_file(node, time),
        raw=str(_value(node, "sourceColorSpace", time)) == "raw",
        wrap=(_WRAPS.get(wrap_s, "repeat"), _WRAPS.get(wrap_t, "repeat")),
        primvar=primvar,
        turn=turn,
        scale=scale,
        offset=offset,
        factor=_four(_value(node, "scale", time), 1.0),
        bias=_four(_value(node, "bias", time), 0.0),
        point=None if connected else _pair(_value(node, "st", time), (0.0, 0.0)),
    )


def _coordinates(
    node: UsdShade.Shader, time: Usd.TimeCode, log: WarningLog
) -> tuple[str, float, tuple[float, float], tuple[float, float]]:
    """Return the primvar's name, and how its values are turned, scaled and moved."""
    turn, scale, offset = 0.0, (1.0, 1.0), (0.0, 0.0)
    source = _upstream(node, "st")
    if source and source.GetIdAttr().Get() == "UsdTransform2d":
        rotation, factors, shift = (_value(source, name, time) for name in ("rotation", "scale", "translation"))
        turn = (numbers(rotation, 1) or (0.0,))[0]
        scale, offset = _pair(factors, scale), _pair(shift, offset)
        source = _upstream(source, "in")
    if source and str(source.GetIdAttr().Get()).startswith("UsdPrimvarReader_float2"):
        return str(_value(source, "varname", time) or "st"), turn, scale, offset
    if source:
        log.add("shader", f"shader nodes {source.GetIdAttr().Get()} are not supported; coordinates 'st' were used")
    return "st", turn, scale, offset


def _upstream(node: UsdShade.Shader, name: str) -> UsdShade.Shader | None:
    source = node.GetInput(name)
    if source:
        for attribute in UsdShade.Utils.GetValueProducingAttributes(source):
            if UsdShade.Output.IsOutput(attribute):
                return UsdShade.Shader(attribute.GetPrim())
    return None


def _value(node: UsdShade.Shader, name: str, time: Usd.TimeCode) -> object:
    """Return an input's constant value, from the node or from the material's interface; None where it has none."""
    attribute = _constant(node, name)
    return attribute.Get(time) if attribute else None


def _constant(node: UsdShade.Shader, name: str) -> Usd.Attribute | None:
    source = node.GetInput(name)
    producing = UsdShade.Utils.GetValueProducingAttributes(source) if source else ()
    return next((one for one in producing if not UsdShade.Output.IsOutput(one)), None)


def _file(node: UsdShade.Shader, time: Usd.TimeCode) -> str:
    """Return the path of a texture's file, there or not; empty for none."""
    attribute = _constant(node, "file")
    value = attribute.Get(time) if attribute else None
    if not isinstance(value, Sdf.AssetPath):
        return ""
    specs = attribute.GetPropertyStack(time) if attribute and value.path and not value.resolvedPath else ()
    return str(specs[0].layer.ComputeAbsolutePath(value.path) if specs else value.resolvedPath)


def _colour(value: object) -> Linear | None:
    """Return a colour; a single number three times."""
    one = numbers(value, 1) if isinstance(value, (int, float)) else None
    found = one * 3 if one else numbers(value, 3)
    return (found[0], found[1], found[2]) if found else None


def _pair(value: object, default: tuple[float, float]) -> tuple[float, float]:
    found = numbers(value, 2)
    return (found[0], found[1]) if found else default


def _four(value: object, default: float) -> tuple[float, float, float, float]:
    found = numbers(value, 4)
    return (found[0], found[1], found[2], found[3]) if found else (default, default, default, default)
