"""How a build is seen: the author's camera and light for its memory, and its preview."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

from voxrt import sim
from voxrt.octree.camera import PLAIN_LIGHTING
from voxrt.options.shared import PREVIEW_SIZE
from voxrt.views.viewpoint import ViewpointError, aim_camera, authored_camera, authored_lighting, stands_inside
from voxrt.voxelize import SceneWarning

if TYPE_CHECKING:
    from collections.abc import Callable

    from voxrt.building.result import BuildResult
    from voxrt.octree.camera import Camera
    from voxrt.options.build_options import BuildOptions
    from voxrt.views.pictures import Picture


def with_view(result: BuildResult, options: BuildOptions) -> BuildResult:
    """Give a result the author's camera and lighting, and a warning for each that cannot be used.

    A memory with baked light is shown flat, and its author's light is not used.
    """
    view, lighting, unseen = None, None, []
    scene, grid = result.scene, result.rom.grid
    assert grid is not None
    if scene.viewpoint is not None:
        try:
            view = authored_camera(scene.viewpoint, grid, PREVIEW_SIZE)
        except ViewpointError as error:
            unseen.append(SceneWarning("camera", str(error)))
    if view is not None and stands_inside(result.rom, view):
        unseen.append(
            SceneWarning("camera", "the scene's camera stands inside a solid; pictures show the whole scene instead")
        )
        view = None
    try:
        lighting = authored_lighting(scene, grid)
    except ViewpointError as error:
        unseen.append(SceneWarning("light", str(error)))
    if options.bake:
        from voxrt.building.baking import FLAT  # noqa: PLC0415 - slow to import, and few builds do this

        if lighting is not None and lighting.on:
            unseen.append(SceneWarning("light", "the scene's light is not used: the sun and the sky were baked"))
        lighting = FLAT if lighting is None else replace(FLAT, bounces=lighting.bounces)
    return replace(result, view=view, lighting=lighting, warnings=(*result.warnings, *unseen))


def preview(result: BuildResult, options: BuildOptions, progress: Callable[[int, int], None] | None = None) -> Picture:
    """Render the preview of a build: of an animation the first frame.

    `progress` is called with the rows that are done and with all rows.
    SimulatorError if the engine cannot hold the memory, the camera or the light; ViewpointError if there is no camera
    for a picture of this size.
    """
    from voxrt.views import pictures  # noqa: PLC0415 - most builds make no picture

    return pictures.preview(
        result.blob,
        _camera(result, options.size),
        options.size,
        engine=options.engine,
        samples=options.samples,
        background=options.background,
        threads=options.threads,
        progress=progress,
    )


def check_preview(result: BuildResult, progress: Callable[[int, int], None] | None = None) -> sim.EngineCheck:
    """Render the view of a preview by both engines, one ray per pixel, and compare them.

    `progress` is called with the rows that are done and with all rows. SimulatorError if the simulated hardware is
    missing, or cannot hold the memory, the camera or the light.
    """
    assert result.preview is not None
    from voxrt.views.pictures import config_of  # noqa: PLC0415 - as above

    height, width = result.preview.frame.material.shape
    lighting = PLAIN_LIGHTING if result.lighting is None else result.lighting
    return sim.check(
        result.rom,
        result.preview.camera,
        (width, height),
        lighting=lighting,
        config=config_of(result.lighting),
        progress=progress,
    )


def _camera(result: BuildResult, size: tuple[int, int]) -> Camera:
    """Return the author's camera if it can be used, or one that sees all of the scene, in all frames."""
    viewpoint, grid = result.scene.viewpoint, result.rom.grid
    if result.view is not None and viewpoint is not None and grid is not None:
        return authored_camera(viewpoint, grid, size)
    if result.animation is None:
        return aim_camera(result.rom, size)
    return sim.frame_animation(result.rom, result.animation.roots, size)
