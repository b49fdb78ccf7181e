"""Notebook cards: a value as a small table with a picture beside it.

Importing this module registers the cards: notebooks find them as ``_repr_html_`` and ``_repr_png_`` of the values'
classes. ``import voxrt`` does so in a notebook.
"""

from __future__ import annotations

import base64
import html
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.octree import Octree, Rom, census, coarsen, material_at
from voxrt.sim import Frame
from voxrt.sim.image import encode_png
from voxrt.view.errors import ViewerError
from voxrt.view.pane import Pane
from voxrt.view.pictures import picture
from voxrt.voxelize import EMPTY, Material

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from numpy.typing import NDArray

    from voxrt.view.pane import Aspect

_SIZE = (480, 360)
_SHOWN_LEVELS = 7  # finer octants would be smaller than the picture's pixels


def card(rows: Iterable[tuple[str, str]], png: bytes) -> str:
    """Give a picture and a table of names and values beside it, as HTML."""
    cells = "".join(f"<tr><th>{html.escape(name)}</th><td>{html.escape(value)}</td></tr>" for name, value in rows)
    source = f"data:image/png;base64,{base64.b64encode(png).decode()}"
    return f'<div><img src="{source}" style="float: left; margin-right: 1em"><table>{cells}</table></div>'


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


def _octree_png(octree: Octree) -> bytes:
    grey = (Material(f"material {number}", (200, 200, 200)) for number in range(1, 256))
    return rom_png(Rom("octree", octree, (EMPTY, *grey)), "level")


def _octree_html(octree: Octree) -> str:
    return card(octree_rows(octree), _octree_png(octree))


def _rom_html(rom: Rom) -> str:
    materials = ", ".join(material.name for material in rom.materials[1:])
    return card([("name", rom.name), *octree_rows(rom.octree), ("materials", materials)], rom_png(rom, "material"))


def _frame_html(frame: Frame) -> str:
    height, width = frame.material.shape
    rows = [("picture", f"{width}x{height} pixels")]
    for name, count, unit in (("cycles", frame.cost.cycles, "pixel"), ("words", frame.cost.words_read, "ray")):
        if count is not None:
            rows.append((name, f"{count:,}, {count / frame.cost.rays:.2f} per {unit}"))
    rows.append(("seconds", f"{frame.cost.seconds:.3f}"))
    return card(rows, encode_png(frame.colour))


def register_card(kind: type, html_of: Callable[[Any], str], png_of: Callable[[Any], bytes] | None = None) -> None:
    """Let notebooks show values of a class by these functions."""
    kind._repr_html_ = html_of  # type: ignore[attr-defined]
    if png_of is not None:
        kind._repr_png_ = png_of  # type: ignore[attr-defined]


register_card(Octree, _octree_html, _octree_png)
register_card(Rom, _rom_html, lambda rom: rom_png(rom, "material"))
register_card(Frame, _frame_html, lambda frame: encode_png(frame.colour))
