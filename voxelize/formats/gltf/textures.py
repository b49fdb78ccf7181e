"""Images and textures of the file.

Source: Khronos, glTF 2.0 specification, section 3.8: colour profiles and orientation that images carry are ignored.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.voxelize.colour.texture import Texture
from voxrt.voxelize.formats.external_files import ALLOW_OUTSIDE
from voxrt.voxelize.formats.gltf.extensions import CONVERT_IMAGES
from voxrt.voxelize.formats.gltf.schema import Sampler, TextureSource
from voxrt.voxelize.formats.image_file import decode_image

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from voxrt.voxelize.colour.texture import Wrap
    from voxrt.voxelize.formats.gltf.document import Document

_NEAREST = 9728
_WRAPS: dict[int, Wrap] = {10497: "repeat", 33648: "mirror", 33071: "clamp"}
_UNREADABLE = {"KHR_texture_basisu": "KTX2", "MSFT_texture_dds": "DDS", "EXT_texture_avif": "AVIF"}


class Textures:
    """The textures of one file; each image is decoded once, when it is first needed."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._images: dict[int, NDArray[np.uint8] | None] = {}
        self._textures: dict[int, Texture | None] = {}

    def read(self, index: int, place: str) -> Texture | None:
        """Return texture `index`, to which `place` refers; None, with a warning, where its image cannot be read."""
        if index not in self._textures:
            self._textures[index] = self._texture(index, place)
        return self._textures[index]

    def _texture(self, index: int, place: str) -> Texture | None:
        document = self._document
        texture = document.item(document.gltf.textures, index, place, "texture")
        here = f"textures[{index}]"
        sampler = Sampler()
        if texture.sampler is not None:
            sampler = document.item(document.gltf.samplers, texture.sampler, f"{here}.sampler", "sampler")
        webp = document.extension(texture, "EXT_texture_webp", TextureSource, here)
        source = webp.source if webp else texture.source
        if source is None:
            kinds = [kind for name, kind in _UNREADABLE.items() if name in texture.extensions]
            what = f"has only a {kinds[0]} image" if kinds else "has no image"
            fix = f"; {CONVERT_IMAGES}" if kinds else ""
            document.log.add("texture", f"{here} {what}: its materials took the colour of their factor{fix}")
            return None
        document.item(document.gltf.images, source, f"{here}.source", "image")
        if source not in self._images:
            self._images[source] = self._image(source)
        pixels = self._images[source]
        if pixels is None:
            return None
        return Texture(pixels, (_WRAPS[sampler.wrap_s], _WRAPS[sampler.wrap_t]), sampler.mag_filter == _NEAREST)

    def _image(self, index: int) -> NDArray[np.uint8] | None:
        document = self._document
        image = document.gltf.images[index]
        here = f"images[{index}]"
        if image.uri is not None and document.is_outside(image.uri):
            problem = f"{image.uri[:60]!r} is outside the asset's folder and was not opened"
            document.log.add("outside", f"{here}: {problem}; {ALLOW_OUTSIDE}")
            return None
        if image.uri is not None:
            data = document.resource(image.uri, f"{here}.uri")
            if data is None:
                problem = f"no image {image.uri[:60]!r} in the asset's folder"
                document.log.add("texture", f"{here}: {problem}; its materials took the colour of their factor")
                return None
        elif image.buffer_view is not None:
            data = document.view(image.buffer_view, f"{here}.bufferView").tobytes()
        else:
            raise document.error(here, "has neither a uri nor a buffer view")
        return decode_image(data, document.path, here, document.log)
