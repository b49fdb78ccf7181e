"""What sim says when it cannot render."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable


class SimulatorError(Exception):
    """The simulator is missing, refuses the memory or the camera, or disagrees with the model."""


class NoSuchConfigurationError(SimulatorError):
    """The installation has no ray tracer of this configuration."""

    def __init__(self, config: str, configs: Iterable[str], *, complete: bool) -> None:
        others = "" if complete else "; run `make configurations` in the checkout for the others"
        super().__init__(
            f"no ray tracer configuration {config!r}; there are {', '.join(sorted(configs)) or 'none'}{others}"
        )
