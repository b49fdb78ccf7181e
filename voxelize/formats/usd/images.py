"""The images of a stage's materials."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from pxr import Ar

from voxrt.voxelize.colour.images import decode_image
from voxrt.voxelize.colour.srgb import LINEAR_OF_SRGB8, srgb_from_linear
from voxrt.voxelize.colour.texture import Texture
from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.companions import ALLOW_OUTSIDE
from voxrt.voxelize.formats.usd.layers import found_at

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.companions import Companions
    from voxrt.voxelize.formats.usd.looks import ImageSource, Look
    from voxrt.voxelize.notes import Notes

_READABLE = (".png", ".jpg", ".jpeg", ".webp", ".bmp", ".tga", ".tif", ".tiff", ".gif")


class Images:
    """Decoded images by asset path; textures by look."""

    def __init__(self, path: Path, companions: Companions, notes: Notes) -> None:
        self._path = path
        self._companions = companions
        self._notes = notes
        self._pixels: dict[str, NDArray[np.uint8] | None] = {}
        self._textures: dict[Look, Texture | None] = {}

    def texture(self, look: Look, faces: int) -> Texture | None:
        """Return the texture of a look: the colour of its image, the alpha of its alpha image.

        Returns
        -------
        None, noted for `faces` faces, where the image is missing or of a kind that is not read.

        Raises
        ------
        AssetError
            The image is broken.
        """
        if look not in self._textures:
            self._textures[look] = self._made(look)
        if self._textures[look] is None:
            message = (
                "textures that are missing or of a kind that is not read: the fallback or default colour stands in"
            )
            self._notes.add("missing-texture", message, faces)
        return self._textures[look]

    def _made(self, look: Look) -> Texture | None:
        source = look.image or look.alpha
        assert source is not None
        colour = self._read(look.image) if look.image is not None else None
        alpha = self._read(look.alpha) if look.alpha is not None else None
        if look.image is not None and colour is None:
            return None
        if colour is None:
            if alpha is None:
                return None
            colour = np.full_like(alpha, 255)
        elif look.image is not None:
            colour = _graded(colour, look.image)
        colour = colour.copy()
        if alpha is None:
            colour[:, :, 3] = 255
        elif alpha.shape == colour.shape and look.alpha is not None:
            channel = "rgba".find(look.alpha.channel)
            colour[:, :, 3] = alpha[:, :, max(channel, 0)]
        else:
            self._notes.add("texture", "textures of opacity of another size than the colour's were ignored")
            colour[:, :, 3] = 255
        return Texture(colour, source.wrap)

    def _read(self, source: ImageSource) -> NDArray[np.uint8] | None:
        file = source.file
        if file not in self._pixels:
            self._pixels[file] = None
            if file and Path(file.rstrip("]")).suffix.lower() in _READABLE:
                found = found_at(file, self._companions)
                if found is not None and not self._companions.allows(found):
                    problem = f"texture {Path(file).name!r} lies outside the file's folder"
                    raise AssetError(self._path, problem, fix=ALLOW_OUTSIDE)
                opened = Ar.GetResolver().OpenAsset(Ar.ResolvedPath(file))
                if opened:
                    self._pixels[file] = decode_image(bytes(opened.GetBuffer()), self._path, Path(file).name)
        return self._pixels[file]


def laid_out(coordinates: NDArray[np.float64], source: ImageSource) -> NDArray[np.float64]:
    """Scale, turn and move texture coordinates (float64, shape (…, 2 or more)), and point v down, as images do."""
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
