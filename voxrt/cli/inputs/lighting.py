"""The lighting of pictures: what is asked for, and what a board can show."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

import voxrt
from voxrt.cli.terminal.messages import warn

if TYPE_CHECKING:
    from collections.abc import Set as AbstractSet

    from voxrt.options.view_options import LightOptions


def supported(lighting: voxrt.Lighting, features: AbstractSet[str]) -> voxrt.Lighting:
    """Leave out, with a warning, what a board has no hardware for: `features` are what it has."""
    missing = sorted(lighting.features - features)
    if not missing:
        return lighting
    warn((voxrt.SceneWarning("light", f"left out, since the board has no hardware for it: {', '.join(missing)}"),))
    return lighting.within(features)


def merge_lighting(authored: voxrt.Lighting | None, options: LightOptions) -> voxrt.Lighting:
    """Return the memory's lighting with what the command line says in its place."""
    lighting = authored or voxrt.Lighting()
    if options.light is not None:
        lighting = replace(lighting, position=options.light, on=True, ambient=voxrt.Lighting().ambient)
    if options.ambient is not None:
        lighting = replace(lighting, ambient=options.ambient)
    if options.bounces is not None:
        lighting = replace(lighting, bounces=options.bounces)
    return lighting if options.shading is None else lighting.shaded(options.shading)
