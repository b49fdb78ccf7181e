"""The textures of a stage's materials."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from pxr import Ar

from voxrt.voxelize.colour.srgb import LINEAR_OF_SRGB8, srgb_from_linear
from voxrt.voxelize.colour.texture import Texture
from voxrt.voxelize.formats.external_files import ALLOW_OUTSIDE
from voxrt.voxelize.formats.image_file import decode_image
from voxrt.voxelize.formats.usd.layers import outer_file

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.external_files import ExternalFiles
    from voxrt.voxelize.formats.reader_process.limits import Allowance
    from voxrt.voxelize.formats.usd.shading import ImageSource, Shading
    from voxrt.voxelize.warning_log import WarningLog

_READABLE = (".png", ".jpg", ".jpeg", ".webp", ".bmp", ".tga", ".tif", ".tiff", ".gif")


class Images:
    """The decoded images and the textures of one stage."""

    def __init__(self, path: Path, external_files: ExternalFiles, log: WarningLog, allowance: Allowance) -> None:
        self._path = path
        self._external_files = external_files
        self._log = log
        self._allowance = allowance
        self._pixels: dict[str, NDArray[np.uint8] | None] = {}
        self._textures: dict[Shading, Texture | None] = {}

    def texture(self, shading: Shading, faces: int) -> Texture | None:
        """Return the texture of a shading, with the colour of its image and the alpha of its alpha image.

        None, with a warning for `faces` faces, where the image is missing or its format is not supported.
        """
        if shading not in self._textures:
            self._textures[shading] = self._combined(shading)
        if self._textures[shading] is None:
            message = (
                "textures that are missing or of an unsupported format were replaced by the fallback or default colour"
            )
            self._log.add("missing-texture", message, faces)
        return self._textures[shading]

    def _combined(self, shading: Shading) -> Texture | None:
        source = shading.image or shading.alpha
        assert source is not None
        colour = self._read(shading.image) if shading.image is not None else None
        alpha = self._read(shading.alpha) if shading.alpha is not None else None
        if shading.image is not None and colour is None:
            return None
        if colour is None:
            if alpha is None:
                return None
            colour = np.full_like(alpha, 255)
        elif shading.image is not None:
            colour = _graded(colour, shading.image)
        colour = colour.copy()
        if alpha is None:
            colour[:, :, 3] = 255
        elif alpha.shape == colour.shape and shading.alpha is not None:
            channel = "rgba".find(shading.alpha.channel)
            colour[:, :, 3] = alpha[:, :, max(channel, 0)]
        else:
            self._log.add("texture", "opacity textures whose size differs from the colour texture's were ignored")
            colour[:, :, 3] = 255
        return Texture(colour, source.wrap)

    def _read(self, source: ImageSource) -> NDArray[np.uint8] | None:
        file = source.file
        if file not in self._pixels:
            self._pixels[file] = None
            if file and Path(file.rstrip("]")).suffix.lower() in _READABLE:
                outer = outer_file(file)
                if self._external_files.is_outside(outer):
                    problem = f"texture {Path(file).name!r} is outside the file's folder and was not opened"
                    self._log.add("outside", f"{problem}; {ALLOW_OUTSIDE}")
                    return None
                found = self._external_files.find(outer)
                if found is not None and file == str(found):  # what a package holds is part of its size
                    self._allowance.add(found.stat().st_size)
                opened = Ar.GetResolver().OpenAsset(Ar.ResolvedPath(file))
                if opened:
                    self._pixels[file] = decode_image(bytes(opened.GetBuffer()), self._path, Path(file).name, self._log)
        return self._pixels[file]


def image_coordinates(coordinates: NDArray[np.float64], source: ImageSource) -> NDArray[np.float64]:
    """Scale, rotate and move texture coordinates (float64, shape (…, 2 or more)), and flip v: image rows go down."""
    scaled = coordinates[..., :2] * source.scale
    angle = np.deg2rad(source.turn)
    cosine, sine = np.cos(angle), np.sin(angle)
    u = scaled[..., 0] * cosine - scaled[..., 1] * sine + source.offset[0]
    v = scaled[..., 0] * sine + scaled[..., 1] * cosine + source.offset[1]
    return np.stack([u, 1.0 - v], axis=-1)


def _graded(pixels: NDArray[np.uint8], source: ImageSource) -> NDArray[np.uint8]:
    """Apply a texture's colour space, scale and bias."""
    plain = source.factor[:3] == (1.0, 1.0, 1.0) and source.bias[:3] == (0.0, 0.0, 0.0)
    if plain and not source.raw:
        return pixels
    linear = pixels[:, :, :3] / 255.0 if source.raw else LINEAR_OF_SRGB8[pixels[:, :, :3]]
    graded = srgb_from_linear(linear * source.factor[:3] + source.bias[:3])
    return np.dstack([graded, pixels[:, :, 3]])
