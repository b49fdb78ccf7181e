"""Notebook cards: a value as a small table with a picture beside it.

Importing this module registers the cards: notebooks find them as ``_repr_html_`` and ``_repr_png_`` of the values'
classes. ``import voxrt`` does so in a notebook. Other packages register cards of their own values by
:func:`register_card`.
"""

from __future__ import annotations

import base64
import html
from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec.structs import replace

from voxrt.octree import Octree, Rom, build, census, coarsen, material_at
from voxrt.sim import Frame, RayPath
from voxrt.sim.image import encode_png
from voxrt.view.errors import ViewerError
from voxrt.view.pane import Pane
from voxrt.view.pictures import picture
from voxrt.view.ray_table import HEADS, describe_end, describe_root, ray_table
from voxrt.voxelize import (
    DEFAULT_COLOURS,
    EMPTY,
    AssetError,
    Material,
    Scene,
    assign_colours,
    fit_grid,
    place_points,
    voxelize,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from numpy.typing import NDArray

    from voxrt.view.pane import Aspect

_SIZE = (480, 360)
_SCENE_DEPTH = 6  # at which scenes are voxelized for their card
_SHOWN_LEVELS = 7  # finer octants would be smaller than the picture's pixels


def card(rows: Iterable[tuple[str, str]], png: bytes | None = None, table: str = "") -> str:
    """Return a table of names and values as HTML, beside a picture and above another table, if there are any.

    Examples
    --------
    >>> card([("depth", "7")])
    '<div><table><tr><th>depth</th><td>7</td></tr></table></div>'
    """
    cells = "".join(f"<tr><th>{html.escape(name)}</th><td>{html.escape(value)}</td></tr>" for name, value in rows)
    picture = ""
    if png is not None:
        source = f"data:image/png;base64,{base64.b64encode(png).decode()}"
        picture = f'<img src="{source}" style="float: left; margin-right: 1em">'
    return f"<div>{picture}<table>{cells}</table>{table}</div>"


def html_table(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table as HTML.

    Examples
    --------
    >>> html_table(["level"], [["0"]])
    '<table><tr><th>level</th></tr><tr><td>0</td></tr></table>'
    """
    head = "".join(f"<th>{html.escape(name)}</th>" for name in heads)
    lines = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table><tr>{head}</tr>{lines}</table>"


def octree_rows(octree: Octree) -> list[tuple[str, str]]:
    """Return what an octree holds, as names and values."""
    return [
        ("world", f"{octree.size} voxels per side, depth {octree.depth}"),
        ("memory", f"{len(octree.words):,} words, {octree.blocks:,} blocks"),
        ("solid", f"{census(octree).solid_voxels:,} voxels"),
    ]


def rom_png(rom: Rom, by: Aspect) -> bytes:
    """Return a picture of a memory as PNG: octants by PyVista if that is installed, else voxels from the front."""
    fine = max(0, rom.octree.depth - _SHOWN_LEVELS)
    shown = replace(rom, octree=coarsen(rom.octree, fine))
    try:
        return encode_png(picture([Pane(shown, by=by)], _SIZE))
    except ViewerError:
        return encode_png(_front(shown, fine))


def _front(rom: Rom, fine: int) -> NDArray[np.uint8]:
    """Return the voxels as seen along -z, nearer ones brighter: uint8, shape (S, S, 3)."""
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


def _scene_html(scene: Scene) -> str:
    triangles = sum(len(item.mesh.triangles) for item in scene.objects)
    colliders = sum(len(item.colliders) for item in scene.objects)
    rows = [
        ("name", scene.name),
        ("objects", f"{len(scene.objects):,}"),
        ("triangles", f"{triangles:,}"),
        *([("colliders", f"{colliders:,}")] if colliders else []),
        ("materials", ", ".join(material.name for material in scene.materials[1:])),
        *(("warning", warning.message) for warning in scene.warnings),
    ]
    return card(rows, _scene_png(scene))


def _scene_png(scene: Scene) -> bytes | None:
    """Return a picture of a scene's voxels as PNG; None if it has nothing to voxelize."""
    try:
        grid = fit_grid(scene, depth=_SCENE_DEPTH)
    except AssetError:
        return None
    coloured = assign_colours(place_points(scene, grid, colours=DEFAULT_COLOURS, fill="auto"), grid)
    return rom_png(Rom(scene.name, build(voxelize(coloured, grid).voxels), coloured.materials, grid), "material")


def _path_html(path: RayPath) -> str:
    x, y, z = (f"{value / 16:g}" for value in path.origin)
    rows = [
        ("ray", f"from voxel {x}, {y}, {z} along {', '.join(map(str, path.direction))}"),
        ("root", describe_root(None, path)),
        ("reads", f"{len(path.readings)} words"),
        ("hits", describe_end(None, path)),
    ]
    return card(rows, table=html_table(HEADS, ray_table(None, path)))


def _frame_html(frame: Frame) -> str:
    height, width = frame.material.shape
    rows = [("picture", f"{width}x{height} pixels")]
    for name, count, unit in (("cycles", frame.cost.cycles, "pixel"), ("words", frame.cost.words_read, "ray")):
        if count is not None:
            rows.append((name, f"{count:,}, {count / frame.cost.rays:.2f} per {unit}"))
    rows.append(("seconds", f"{frame.cost.seconds:.3f}"))
    return card(rows, frame._repr_png_())


def register_card(kind: type, html_of: Callable[[Any], str], png_of: Callable[[Any], bytes] | None = None) -> None:
    """Let notebooks show the values of a class as HTML, and as a PNG if there is a function for that."""
    kind._repr_html_ = html_of  # type: ignore[attr-defined]
    if png_of is not None:
        kind._repr_png_ = png_of  # type: ignore[attr-defined]


register_card(Octree, _octree_html, _octree_png)
register_card(Rom, _rom_html, lambda rom: rom_png(rom, "material"))
register_card(Scene, _scene_html)
register_card(RayPath, _path_html)
register_card(Frame, _frame_html)
