"""The options of a picture: what :func:`voxrt.render` takes besides the memory and the camera."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from msgspec.structs import asdict

from voxrt.options.option import OptionTable, check_options, documented, option
from voxrt.options.shared import ANYTHING, BACKGROUND, CONFIG, ENGINE, SAMPLES, SIZE, Engine

if TYPE_CHECKING:
    from voxrt.octree.camera import Lighting
    from voxrt.sim import Background, Dram


# A table: an option is its kind, its default and its group, then its text.
# fmt: off
@documented
class RenderOptions(OptionTable, frozen=True, kw_only=True):
    """How a picture is rendered.

    Raises
    ------
    TypeError, ValueError
        An option has a value of the wrong type, or one that is out of range.

    Examples
    --------
    >>> from voxrt import RenderOptions
    >>> RenderOptions(background="light").background
    (236, 240, 244)
    >>> RenderOptions().chosen_engine, RenderOptions(config="cached1").chosen_engine
    ('model', 'rtl')
    """

    size: tuple[int, int] = SIZE.field()
    engine: Engine | None = ENGINE.field(
        details="The default is rtl where {config} or {dram} is given, else model.")
    config: str | None = CONFIG.field(help="The configuration of the hardware. The default is tiny.")
    lighting: Lighting | None = option(ANYTHING, None, None,
        "Brightness of faces, light and mirrors. For light and mirrors the hardware needs a configuration that has "
        "them. None takes the default brightness of faces.")
    samples: int = SAMPLES.field()
    background: Background | str | None = BACKGROUND.field()
    threads: int = option(ANYTHING, 0, None, "Threads of the model; 0 takes one per core.")
    dram: Dram | None = option(ANYTHING, None, None,
        "The external memory of a configuration that has caches. None takes the default of voxrt.sim.Dram.")
    root: int = option(ANYTHING, 0, None,
        "The word of the memory that is the root of what is rendered; 0 but for the frames of an animation.")
    lod: float = option(ANYTHING, 0.0, None,
        "Level of detail: the width in pixels of the widest cell that rays stop at; True is 1. 0: they go down to "
        "the leaves. The memory is built with lod=True.")

    def __post_init__(self) -> None:
        super().__post_init__()
        check_options(self)

    @property
    def chosen_engine(self) -> Engine:
        """What renders the picture."""
        return self.engine or ("model" if self.config is None and self.dram is None else "rtl")

    def for_engines(self) -> dict[str, Any]:
        """Return what both engines take, as keywords of :func:`voxrt.sim.check`; `engine` is for one of them alone."""
        from voxrt.octree.camera import PLAIN_LIGHTING  # noqa: PLC0415 - NumPy comes with it

        keywords = {name: value for name, value in asdict(self).items() if name != "engine"}
        return {**keywords, "config": self.config or "tiny", "lighting": self.lighting or PLAIN_LIGHTING}
