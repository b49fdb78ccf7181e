"""What ``--json`` prints: the shape of each command's result.

Programs rely on the names of the fields: new ones may come, none changes.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import msgspec
from msgspec.structs import asdict

from voxrt.cli.terminal.messages import name_file, print_answer
from voxrt.export.provenance import BakedLight  # noqa: TC001 - msgspec resolves the annotations of this module
from voxrt.voxelize import SceneWarning  # noqa: TC001

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.building.fitting import BudgetFit
    from voxrt.building.result import BuildResult
    from voxrt.export import RomInfo
    from voxrt.sim import CacheCost, Camera, EngineCheck, RenderCost
    from voxrt.views.pictures import Picture


class MaterialEntry(msgspec.Struct, frozen=True):
    """A row of the material table."""

    id: int
    name: str
    colour: tuple[int, int, int]
    """sRGB, 8 bits per channel."""
    authored: bool
    """False for the default material of objects without a material."""


class CameraEntry(msgspec.Struct, frozen=True):
    """The camera of a picture."""

    position: tuple[float, float, float]
    """Voxels."""
    look: tuple[int, int, int]
    right: tuple[int, int, int]
    up: tuple[int, int, int]


class CacheEntry(msgspec.Struct, frozen=True):
    """What a picture cost at the caches of a configuration that has them."""

    l1_hits: float
    """Part of the words that needed no line from the shared cache, 0 to 1."""
    l2_hits: float
    """Part of the lines asked for that the shared cache had."""
    lines_per_pixel: float
    """Lines of 32 bytes from the external memory."""
    bytes_per_pixel: float
    requests_per_word: float
    """How often lanes asked for each word that they read."""


class RenderResult(msgspec.Struct, frozen=True, omit_defaults=True):
    """``voxrt render --json``, and `render` in ``voxrt build --json``."""

    engine: str
    size: tuple[int, int]
    rays: int
    cycles: int | None
    """Clocks of the ray tracer; null from the model, which has no clock."""
    words_read: int | None
    """Octree words; null from the model, which reads one word for many rays."""
    cycles_per_pixel: float | None
    words_per_ray: float | None
    seconds: float
    camera: CameraEntry
    outputs: dict[str, str] | msgspec.UnsetType = msgspec.UNSET
    """Files written, by kind: `picture`. In a build they stand with the build's."""
    cache: CacheEntry | msgspec.UnsetType = msgspec.UNSET
    """The cache; missing for a configuration without one."""
    wrong_pixels: int | msgspec.UnsetType = msgspec.UNSET
    """With ``--check``: pixels on which the two engines differ."""


class CheckEntry(msgspec.Struct, frozen=True):
    """The view of the preview by the simulated hardware, one ray per pixel, beside the exact model."""

    pixels: int
    wrong_pixels: int
    """Pixels on which the two differ."""
    cycles_per_pixel: float
    words_per_ray: float
    seconds: float

    @classmethod
    def of(cls, check: EngineCheck) -> CheckEntry:
        """Return what a check found."""
        cost = check.rtl.cost
        cycles, words = (count or 0 for count in (cost.cycles, cost.words_read))
        return cls(check.wrong.size, check.wrong_pixels, cycles / cost.rays, words / cost.rays, cost.seconds)


class BudgetEntry(msgspec.Struct, frozen=True):
    """What fitting a memory to a budget took."""

    words: int
    """The budget."""
    words_before: int
    """What the memory takes without it."""
    percent_changed: float
    """Percent of the surface voxels that vanished or took another material."""
    appeared: int
    """Voxels that became solid."""
    recoloured: int
    """Voxels that took another material, hidden ones included."""
    psnr: float | None
    """Ratio of the scene's picture to that without a budget, decibel; null where they are equal."""
    ssim: float
    lossless: tuple[int, int] | None = None
    """The greatest depth that fits without loss, and its words there, where much was given up."""


class InteriorEntry(msgspec.Struct, frozen=True):
    """What became of voxels that no ray from outside can reach."""

    material: int | None
    """What they are made of now; null where each took whatever lets most blocks be shared."""
    hidden: int
    """How many they are."""
    words_before: int
    """What the memory takes when they keep their materials."""


class FramesEntry(msgspec.Struct, frozen=True):
    """The frames of an animation."""

    roots: list[int]
    """The words of the memory that are their roots: what the register `root` takes."""
    words_alone: int
    """Words of all frames, each in a memory of its own."""


class BuildReport(msgspec.Struct, frozen=True):
    """``voxrt build --json``."""

    outputs: dict[str, str]
    """Files written, by kind: `mem`, `manifest`, `preview`."""
    depth: int
    words: int
    blocks: int
    voxels: int
    materials: list[MaterialEntry]
    warnings: tuple[SceneWarning, ...]
    seconds: dict[str, float]
    """Wall seconds per stage, in order. `start`: from the start of the process; `rest`: between the stages."""
    render: RenderResult | None
    """The preview; null when none was asked for."""
    budget: BudgetEntry | None = None
    """Null when there was none."""
    interior: InteriorEntry | None = None
    """Null when they keep their materials."""
    baked: BakedLight | None = None
    """Null when no light was baked."""
    check: CheckEntry | None = None
    """Null when the preview was not compared with the simulated hardware."""
    frames: FramesEntry | None = None
    """Null when no animation was built."""


def build_report(result: BuildResult, seconds: dict[str, float], check: EngineCheck | None = None) -> BuildReport:
    """Return what a build made, for programs. `seconds`: its stages, with what came before and between them."""
    rom, animation = result.rom, result.animation
    return BuildReport(
        outputs={kind: name_file(path) for kind, path in result.outputs.items()},
        depth=rom.octree.depth,
        words=len(rom.octree.words),
        blocks=rom.octree.blocks,
        voxels=result.solid_voxels,
        materials=[
            MaterialEntry(number, material.name, material.colour, material.authored)
            for number, material in enumerate(rom.materials)
        ],
        warnings=result.warnings,
        seconds=seconds,
        render=None if result.preview is None else render_result(result.preview),
        budget=None if result.budget is None else budget_entry(result.budget),
        interior=None if result.interior is None else InteriorEntry(**asdict(result.interior)),
        baked=result.bake,
        check=None if check is None else CheckEntry.of(check),
        frames=None if animation is None else FramesEntry(list(animation.roots), animation.words_alone),
    )


def budget_entry(budget: BudgetFit) -> BudgetEntry:
    """Give what fitting a budget took."""
    fit = budget.fit
    return BudgetEntry(
        words=budget.words,
        words_before=fit.words_shared,
        percent_changed=fit.percent_changed,
        appeared=fit.appeared,
        recoloured=fit.recoloured,
        psnr=budget.psnr if math.isfinite(budget.psnr) else None,
        ssim=budget.ssim,
        lossless=budget.lossless,
    )


def render_result(picture: Picture, file: Path | None = None, wrong_pixels: int | None = None) -> RenderResult:
    """Return what a picture shows and cost, for programs."""
    cost, camera = picture.frame.cost, picture.camera
    height, width = picture.frame.material.shape
    return RenderResult(
        engine=picture.engine,
        size=(width, height),
        rays=cost.rays,
        cycles=cost.cycles,
        words_read=cost.words_read,
        cycles_per_pixel=None if cost.cycles is None else cost.cycles / cost.rays,
        words_per_ray=None if cost.words_read is None else cost.words_read / cost.rays,
        seconds=cost.seconds,
        camera=camera_entry(camera),
        outputs=msgspec.UNSET if file is None else {"picture": name_file(file)},
        cache=msgspec.UNSET if cost.cache is None else _cache_entry(cost, cost.cache),
        wrong_pixels=msgspec.UNSET if wrong_pixels is None else wrong_pixels,
    )


def _cache_entry(cost: RenderCost, cache: CacheCost) -> CacheEntry:
    return CacheEntry(
        l1_hits=cache.l1_hits,
        l2_hits=cache.l2_hits,
        lines_per_pixel=cache.lines_read / cost.rays,
        bytes_per_pixel=cache.bytes_read / cost.rays,
        requests_per_word=cache.word_requests / max(cost.words_read or 0, 1),
    )


def camera_entry(camera: Camera) -> CameraEntry:
    """Return a camera, for programs."""
    x, y, z = camera.position
    return CameraEntry((x / 16, y / 16, z / 16), camera.look, camera.right, camera.up)


def print_json(result: msgspec.Struct | RomInfo | list[BuildReport] | list[RenderResult]) -> None:
    """Print a result on standard output, as :func:`print_answer` does."""
    print_answer(msgspec.json.format(msgspec.json.encode(result), indent=2).decode() + "\n")
