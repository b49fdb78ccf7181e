"""The materials of a COLLADA file as appearances: colour or texture, emission, opacity in its four modes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec import Struct, field

from voxrt.voxelize.colour.appearance import Appearance
from voxrt.voxelize.colour.srgb import LINEAR_OF_SRGB8
from voxrt.voxelize.colour.texture import Texture
from voxrt.voxelize.formats.colour_range import clamped
from voxrt.voxelize.formats.external_files import read_asset
from voxrt.voxelize.formats.image_file import INSTEAD, decode_image

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from voxrt.voxelize.formats.external_files import ExternalFiles
    from voxrt.voxelize.warning_log import WarningLog

_LUMINANCE = (0.212671, 0.715160, 0.072169)  # COLLADA 1.5.0, "Determining Transparency"


COLOURED = Appearance("vertex colours")
"""The appearance of vertex colours without a material."""


class Materials(Struct, frozen=True):
    """Reads each material and each image once."""

    path: Path
    external_files: ExternalFiles
    log: WarningLog
    opaque_from: float
    _appearances: dict[str, Appearance] = field(default_factory=dict)
    _textures: dict[tuple[str, bool], Texture | None] = field(default_factory=dict)

    def appearance(self, material: Any) -> Appearance:  # noqa: ANN401 - pycollada has no types
        """Return the appearance of a material."""
        if material.id not in self._appearances:
            self._appearances[material.id] = self._read(material.name or material.id, material.effect)
        return self._appearances[material.id]

    def _read(self, name: str, effect: Any) -> Appearance:  # noqa: ANN401
        shown = effect.diffuse
        if _is_black(shown) and effect.emission is not None and not _is_black(effect.emission):
            shown = effect.emission  # what reflects nothing shows what it emits
        rgba = self._colour(effect.diffuse)
        opacity = self._opacity(effect, 1.0 if rgba is None or len(rgba) < 4 else float(rgba[3]))
        has_alpha = _image_of(shown) != "" and _image_of(effect.transparent) == _image_of(shown)
        texture = self._texture(_image_of(shown), has_alpha=has_alpha)
        if _image_of(effect.transparent) and not (has_alpha and _mode(effect) == "A_ONE"):
            self.log.add("texture", "textures of opacity were not read, but for the alpha of the colour's own")
        colour = self._colour(shown)
        red, green, blue = (1.0, 1.0, 1.0) if texture or colour is None else self.linear(colour).tolist()
        cutoff = self.opaque_from if opacity < 1 or has_alpha else 0.0
        return Appearance(name, (red, green, blue, opacity), texture, cutoff)

    def linear(self, colours: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the linear red, green and blue of sRGB colours within 0 … 1, shape (…, 3 or 4)."""
        return LINEAR_OF_SRGB8[np.round(colours[..., :3] * 255).astype(np.uint8)]

    def _colour(self, value: object) -> NDArray[np.float64] | None:
        """Return a colour of three or four numbers, 0 … 1; None for textures and what is none."""
        return clamped(value, self.log) if isinstance(value, (tuple, list)) and len(value) in (3, 4) else None

    def _opacity(self, effect: Any, opacity: float) -> float:  # noqa: ANN401
        """Return the opacity that an effect states; `opacity`, of its colour, where it states none."""
        stated, amount = (effect.xmlnode.find(f".//{{*}}{tag}") for tag in ("transparent", "transparency"))
        if stated is None and amount is None:
            return opacity
        if _image_of(effect.transparent):
            return 1.0
        colour = self._colour(effect.transparent) if stated is not None else None
        red, green, blue, alpha = (1.0,) * 4 if colour is None else [*colour.tolist(), 1.0][:4]
        light = sum(one * share for one, share in zip((red, green, blue), _LUMINANCE, strict=True))
        mode = _mode(effect)
        share = effect.transparency if amount is not None and isinstance(effect.transparency, float) else 1.0
        share *= light if mode.startswith("RGB") else alpha
        return min(max(1.0 - share if mode.endswith("ZERO") else share, 0.0), 1.0)

    def _texture(self, image: str, *, has_alpha: bool) -> Texture | None:
        key = image, has_alpha
        if image and key not in self._textures:
            files = self.external_files
            found = files.reported(files.find_exported(image), "texture", image, self.log, instead=INSTEAD)
            data = b"" if found is None else read_asset(found)
            pixels = decode_image(data, self.path, f"texture {image}", self.log) if data else None
            if pixels is not None and not has_alpha:
                pixels[:, :, 3] = 255
            self._textures[key] = None if pixels is None else Texture(pixels)
        return self._textures.get(key)


def _mode(effect: Any) -> str:  # noqa: ANN401
    """Return how an effect states its opacity, one of four modes; pycollada knows two."""
    stated = effect.xmlnode.find(".//{*}transparent")
    mode = None if stated is None else stated.get("opaque")
    return mode if mode in {"A_ZERO", "RGB_ZERO", "RGB_ONE"} else "A_ONE"


def _is_black(value: object) -> bool:
    """Tell whether a colour is missing or reflects nothing."""
    return value is None or (isinstance(value, (tuple, list)) and not any(component > 0 for component in value[:3]))


def _image_of(value: Any) -> str:  # noqa: ANN401
    """Return the name of the file of a texture; none for other values."""
    surface = getattr(getattr(value, "sampler", None), "surface", None)
    return str(surface.image.path) if surface is not None else ""
