"""What notebooks show of a value: a small table, with a picture in it."""

from __future__ import annotations

import base64
import html
import io
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from PIL import Image

from voxrt.octree.budget import coarsen
from voxrt.octree.census import census
from voxrt.octree.errors import ViewerError
from voxrt.octree.pane import Pane
from voxrt.octree.query import material_at
from voxrt.octree.view import picture

if TYPE_CHECKING:
    from collections.abc import Iterable

    from numpy.typing import NDArray

    from voxrt.octree.octree import Octree
    from voxrt.octree.pane import Aspect
    from voxrt.octree.rom import Rom

_SIZE = (480, 360)
_SHOWN_LEVELS = 7  # finer octants would be smaller than the picture's pixels


def card(rows: Iterable[tuple[str, str]], png: bytes) -> str:
    """Give a picture and a table of names and values beside it, as HTML."""
    cells = "".join(f"<tr><th>{html.escape(name)}</th><td>{html.escape(value)}</td></tr>" for name, value in rows)
    source = f"data:image/png;base64,{base64.b64encode(png).decode()}"
    return f'<div><img src="{source}" style="float: left; margin-right: 1em"><table>{cells}</table></div>'


def encode_png(colour: NDArray[np.uint8]) -> bytes:
    """Give a picture (uint8, shape (H, W, 3), sRGB) as a PNG file's bytes: the same pixels give the same bytes."""
    encoded = io.BytesIO()
    Image.fromarray(colour, "RGB").save(encoded, format="PNG")
    return encoded.getvalue()


def octree_rows(octree: Octree) -> list[tuple[str, str]]:
    """Tell what an octree holds."""
    return [
        ("world", f"{octree.size} voxels a side, depth {octree.depth}"),
        ("memory", f"{len(octree.words):,} words, {octree.blocks:,} blocks"),
        ("solid", f"{census(octree).solid_voxels:,} voxels"),
    ]


def rom_png(rom: Rom, by: Aspect) -> bytes:
    """Draw a memory's octants by PyVista where there is one, else its voxels from the front."""
    fine = max(0, rom.octree.depth - _SHOWN_LEVELS)
    shown = replace(rom, octree=coarsen(rom.octree, fine))
    try:
        return encode_png(picture([Pane(shown, by=by)], _SIZE))
    except ViewerError:
        return encode_png(_front(shown, fine))


def _front(rom: Rom, fine: int) -> NDArray[np.uint8]:
    """See the voxels along -z, the nearer the brighter: uint8, shape (2**n, 2**n, 3)."""
    places = np.stack(np.meshgrid(*[np.arange(0, rom.octree.size, 1 << fine)] * 3, indexing="ij"), axis=-1)
    dense = material_at(rom.octree, places)
    depth = np.argmax(dense[:, :, ::-1] != 0, axis=2)
    material = np.take_along_axis(dense, dense.shape[2] - 1 - depth[:, :, None], axis=2)[:, :, 0]
    palette = np.zeros((256, 3))
    palette[: len(rom.materials)] = [entry.colour for entry in rom.materials]
    shade = np.where(material > 0, 1 - 0.6 * depth / dense.shape[2], 1.0)
    seen = palette[material] * shade[:, :, None]
    side = max(1, _SIZE[1] // len(dense))
    flat = seen.transpose(1, 0, 2)[::-1].repeat(side, axis=0).repeat(side, axis=1)
    return np.rint(flat).astype(np.uint8)
