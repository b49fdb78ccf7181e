"""The lighting that a board can show."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import voxrt
from voxrt.cli.messages import warn

if TYPE_CHECKING:
    from collections.abc import Set as AbstractSet


def supported(lighting: voxrt.Lighting, features: AbstractSet[str]) -> voxrt.Lighting:
    """Leave out, with a warning, what a board has no hardware for: `features` are what it has."""
    missing = sorted(lighting.features - features)
    if not missing:
        return lighting
    warn((voxrt.SceneWarning("light", f"left out, since the board has no hardware for it: {', '.join(missing)}"),))
    return replace(
        lighting,
        on=lighting.on and "light" in features,
        bounces=lighting.bounces if "mirrors" in features else 0,
    )
