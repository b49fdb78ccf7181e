"""Notebook cards of voxrt's own values; importing this module registers them, and those of the rooms."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.building.result import BuildResult
from voxrt.view.cards import card, octree_rows, register_card
from voxrt.views.pictures import Picture

if TYPE_CHECKING:
    from voxrt.sim import Frame


def _build_html(result: BuildResult) -> str:
    rom = result.rom
    rows = [
        ("name", rom.name),
        *octree_rows(rom.octree),
        *([("voxel", f"{rom.grid.voxel_size:.4g} m")] if rom.grid else []),
        ("materials", ", ".join(material.name for material in rom.materials[1:])),
        *(("warning", warning.message) for warning in result.warnings),
        ("seconds", f"{sum(result.seconds.values()):.2f}"),
        *((kind, str(path)) for kind, path in result.outputs.items()),
    ]
    return card(rows, result._repr_png_())


def _picture_html(picture: Picture) -> str:
    frame: Frame = picture.frame
    height, width = frame.material.shape
    return card([("picture", f"{width}x{height} pixels, by {picture.engine}")], picture._repr_png_())


register_card(BuildResult, _build_html)
register_card(Picture, _picture_html)
