"""Which objects and which camera of a scene a build uses, and what it says where objects get no voxel."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

from voxrt.voxelize import AssetError, DoesNotFitError, SceneWarning
from voxrt.voxelize.dominant_objects import dominant_objects
from voxrt.voxelize.stray_parts import find_stray_parts

if TYPE_CHECKING:
    from collections.abc import Sequence

    from voxrt.options.build_options import BuildOptions
    from voxrt.voxelize import Grid, ObjectReport, Scene, Viewpoint
    from voxrt.voxelize.stray_parts import StrayParts

_MOST_NAMES = 3


def without_objects(label: str, scene: Scene, names: Sequence[str]) -> Scene:
    """Return a scene without the objects of these names, and without those below these prim paths.

    AssetError if no object has such a name, or none is left; `label` is what the message calls the asset.

    Examples
    --------
    >>> from voxrt import load
    >>> scene = load("examples/dog.usda")
    >>> len(scene.objects), len(without_objects("dog.usda", scene, [scene.objects[0].name]).objects)
    (19, 18)
    """
    kept = scene.objects
    for name in names:
        below = name.rstrip("/") + "/"
        left = tuple(one for one in kept if one.name != name and not (name[:1] == "/" and one.name.startswith(below)))
        if len(left) == len(kept):
            known = ", ".join(repr(one.name) for one in kept)
            raise AssetError(label, f"has no object {name!r} to ignore", fix=f"it has {known}")
        kept = left
    if not kept:
        raise AssetError(label, "nothing is left to voxelize", fix="ignore fewer objects")
    return replace(scene, objects=kept) if names else scene


def named_camera(label: str, scene: Scene, name: str) -> Viewpoint:
    """Return the author's camera with a name, or with a number, counted from 0.

    AssetError if the scene has no such camera; `label` is what the message calls it.

    Examples
    --------
    >>> from voxrt.voxelize import EMPTY, Scene, Viewpoint
    >>> cameras = Viewpoint((1, 1, 1), (0, 0, 0), name="left"), Viewpoint((9, 1, 1), (0, 0, 0), name="right")
    >>> named_camera("yard", Scene("yard", (), (EMPTY,), cameras=cameras), "right").eye
    (9.0, 1.0, 1.0)
    """
    found = [camera for camera in scene.cameras if camera.name == name]
    if not found and name.isdecimal() and int(name) < len(scene.cameras):
        found = [scene.cameras[int(name)]]
    if not found:
        names = ", ".join(camera.name or str(number) for number, camera in enumerate(scene.cameras))
        there, fix = (f"there are {names}", "name one of these") if names else ("it has none", "leave it out")
        raise AssetError(label, f"there is no camera {name!r}: {there}", fix=fix)
    return found[0]


def crowded_out(scene: Scene, grid: Grid, options: BuildOptions) -> tuple[SceneWarning, ...]:
    """Return a warning where stray parts or large objects leave few voxels to the rest; none where the user chose.

    Examples
    --------
    >>> from voxrt import BuildOptions, fit_grid, load
    >>> scene = load("examples/house.obj")
    >>> crowded_out(scene, fit_grid(scene, depth=5), BuildOptions())
    ()
    """
    if options.bounds is not None or options.voxel_size is not None:
        return ()
    stray = find_stray_parts(scene, options.geometry)
    if stray is not None:
        return (SceneWarning("stray-parts", _stray_message(stray), len(stray.names)),)
    names, width = dominant_objects(scene, grid.size, options.geometry)
    if not names:
        return ()
    whole = grid.size * grid.voxel_size
    message = (
        f"{', '.join(names)} {'span' if len(names) > 1 else 'spans'} {whole:.4g} m, all other objects {width:.4g} m, "
        "so that they get few voxels: leave large ones out with --ignore NAME, or give the grid --bounds"
    )
    return (SceneWarning("dominant-object", message, len(names)),)


def _stray_message(stray: StrayParts) -> str:
    wide = max(high - low for low, high in zip(stray.low, stray.high, strict=True))
    bounds = ",".join(f"{value:.6g}" for value in (*stray.low, *stray.high))
    fix = f"leave it out with --bounds={bounds}"
    if stray.whole == stray.names:
        fix += f", or with --ignore {stray.names[0]}"
    return (
        f"{stray.share:.2%} of the surface spans {wide:.4g} m of {stray.width:.4g} m, so that it gets few voxels: "
        f"{', '.join(stray.names[:_MOST_NAMES])} reaches to {', '.join(f'{value:.6g}' for value in stray.place)}: {fix}"
    )


def refuse_empty(label: str, grid: Grid, objects: Sequence[ObjectReport], points: int | None = None) -> None:
    """Refuse a scene of which no object got a voxel, with a DoesNotFitError. `points` were asked for per voxel.

    Examples
    --------
    >>> from voxrt import fit_grid, load
    >>> from voxrt.voxelize import voxelize
    >>> scene = load("examples/house.obj")
    >>> grid = fit_grid(scene, depth=4)
    >>> refuse_empty("house.obj", grid, voxelize(scene, grid).objects)
    """
    if any(one.voxels for one in objects):
        return
    if points is not None:
        raise DoesNotFitError(f"{label}: the memory is empty: no voxel holds {points} points; ask for fewer (--points)")
    raise DoesNotFitError(
        f"{label}: the memory is empty: no object has a voxel in the grid, which is "
        f"{grid.size * grid.voxel_size:.4g} m wide with voxels of {grid.voxel_size:.4g} m; repair what is far away or "
        "tiny, leave it out (--ignore NAME), choose --bounds, or accept it with --allow-empty"
    )
