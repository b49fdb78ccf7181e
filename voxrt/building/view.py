"""How a build is seen: the author's camera and light for its memory, and its preview."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from voxrt.options.shared import PREVIEW_SIZE
from voxrt.views.viewpoint import ViewpointError, authored_camera, authored_lighting, stands_inside
from voxrt.voxelize import SceneWarning

if TYPE_CHECKING:
    from voxrt.octree import Rom
    from voxrt.octree.camera import Camera, Lighting
    from voxrt.options.build_options import BuildOptions
    from voxrt.views.pictures import Picture
    from voxrt.voxelize import Scene


def preview(rom: Rom, camera: Camera, lighting: Lighting | None, options: BuildOptions) -> Picture:
    """Render the preview of a build.

    Raises
    ------
    SimulatorError
        The engine cannot hold the memory, the camera or the light.
    """
    from voxrt.views.pictures import Picture, render  # noqa: PLC0415 - most builds make no picture

    frame = render(
        rom,
        camera,
        size=options.size,
        engine=options.engine,
        config="lit" if lighting is not None and lighting.features else "tiny",
        lighting=lighting,
        samples=options.samples,
        background=options.background,
        threads=options.threads,
    )
    return Picture(frame, camera, options.engine)


def authored_view(
    scene: Scene, rom: Rom, options: BuildOptions
) -> tuple[Camera | None, Lighting | None, tuple[SceneWarning, ...]]:
    """Return the author's camera and lighting for a memory, and a warning for each that cannot be used.

    A memory with baked light is shown flat, and its author's light is not used.
    """
    view, lighting, unseen = None, None, []
    grid = rom.grid
    assert grid is not None
    if scene.viewpoint is not None:
        try:
            view = authored_camera(scene.viewpoint, grid, PREVIEW_SIZE)
        except ViewpointError as error:
            unseen.append(SceneWarning("camera", str(error)))
    if view is not None and stands_inside(rom, view):
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
    return view, lighting, tuple(unseen)
