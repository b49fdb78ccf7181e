"""Images of Blender as textures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.voxelize.colour.srgb import srgb_from_linear
from voxrt.voxelize.colour.texture import Texture, Wrap
from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.image_file import INSTEAD, MOST_PIXELS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.blend.nodes import ImageUse
    from voxrt.voxelize.warning_log import WarningLog

_WRAPS: dict[str, Wrap] = {"REPEAT": "repeat", "MIRROR": "mirror", "EXTEND": "clamp", "CLIP": "clamp"}
_LUMINANCE = (0.2126, 0.7152, 0.0722)


class Images:
    """The textures of one scene; each image is read once."""

    def __init__(self, path: object, log: WarningLog) -> None:
        self._path = path
        self._log = log
        self._pixels: dict[str, NDArray[np.uint8] | None] = {}
        self._textures: dict[tuple[object, ...], Texture | None] = {}

    def texture(self, colour: ImageUse | None, alpha: ImageUse | None, channel: str) -> Texture | None:
        """Return the texture of a colour image and an alpha image, either of which may be None.

        `channel` of the alpha image is the opacity. None, with a warning, where the colour image cannot be read.
        """
        use = colour or alpha
        assert use is not None
        names = tuple(one and one.image.name_full for one in (colour, alpha))
        key = (*names, channel, use.extension, use.nearest)
        if key not in self._textures:
            if use.extension == "CLIP":
                self._log.add("texture", "textures that are clipped were extended by their border")
            pixels = self._combined(colour, alpha, channel)
            wrap = _WRAPS.get(use.extension, "repeat")
            self._textures[key] = None if pixels is None else Texture(pixels, (wrap, wrap), use.nearest)
        return self._textures[key]

    def _combined(self, colour: ImageUse | None, alpha: ImageUse | None, channel: str) -> NDArray[np.uint8] | None:
        opacity = None if alpha is None else self._read(alpha.image)
        if opacity is not None:
            opacity = opacity[:, :, 3] if channel == "alpha" else _luminance(opacity)
        if colour is None:
            return None if opacity is None else np.dstack([np.full((*opacity.shape, 3), 255, np.uint8), opacity])
        pixels = self._read(colour.image)
        if pixels is None:
            return None
        if opacity is not None and opacity.shape != pixels.shape[:2]:
            self._log.add("texture", "opacity textures whose size differs from the colour texture's were ignored")
            opacity = None
        return np.dstack([pixels[:, :, :3], np.full(pixels.shape[:2], 255, np.uint8) if opacity is None else opacity])

    def _read(self, image: Any) -> NDArray[np.uint8] | None:
        name = str(image.name_full)
        if name not in self._pixels:
            self._pixels[name] = self._decoded(image, name)
        return self._pixels[name]

    def _decoded(self, image: Any, name: str) -> NDArray[np.uint8] | None:
        if image.source == "TILED":
            self._log.add("texture", f"image {name!r} has several tiles and was not read{INSTEAD}")
            return None
        width, height = image.size  # which reads the file
        if width * height > MOST_PIXELS:
            problem = f"the image has more than {MOST_PIXELS:,} pixels"
            raise AssetError(self._path, problem, place=name, fix="scale it down")
        if not width * height:
            self._log.add("missing-texture", f"image {name!r} was not found or cannot be read{INSTEAD}")
            return None
        values = np.empty(width * height * image.channels, np.float32)
        image.pixels.foreach_get(values)
        return _as_rgba(image, values.reshape(height, width, image.channels)[::-1])


def _as_rgba(image: Any, values: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Return sRGB colour and linear alpha of an image's numbers, whose rows go down."""
    channels = values.shape[2]
    colour: NDArray[np.floating] = values[:, :, :3] if channels >= 3 else np.repeat(values[:, :, :1], 3, axis=2)
    alpha = values[:, :, 3] if channels == 4 else np.ones(values.shape[:2], np.float32)
    if image.is_float and image.alpha_mode == "PREMUL":
        colour = colour / np.where(alpha > 0, alpha, 1)[:, :, None]
    space = image.colorspace_settings
    if image.is_float or space.is_data or space.name.startswith("Linear"):
        coded = srgb_from_linear(np.nan_to_num(colour, nan=0.0))
    else:
        coded = _bytes(colour)
    return np.dstack([coded, _bytes(alpha)])


def _bytes(values: NDArray[np.floating]) -> NDArray[np.uint8]:
    coded: NDArray[np.uint8] = np.rint(np.clip(np.nan_to_num(values, nan=0.0), 0, 1) * 255).astype(np.uint8)
    return coded


def _luminance(pixels: NDArray[np.uint8]) -> NDArray[np.uint8]:
    mixed: NDArray[np.float64] = pixels[:, :, :3] @ np.array(_LUMINANCE)
    return np.rint(mixed).astype(np.uint8)
