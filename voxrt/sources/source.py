"""What a build can start from: a file, arrays, a mesh of trimesh, a scene."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias, Union

from voxrt import voxelize
from voxrt.voxelize import AssetError, Scene, SceneWarning

if TYPE_CHECKING:
    import trimesh
    from numpy.typing import ArrayLike

    from voxrt.options.build_options import BuildOptions

Asset: TypeAlias = Union[
    str, "os.PathLike[str]", Scene, "tuple[ArrayLike, ArrayLike]", "trimesh.Trimesh", "trimesh.Scene"
]
"""A file's path; a scene; vertices (V, 3) and faces (F, 3); a mesh or a scene of trimesh."""


def asset_name(asset: Asset) -> str:
    """Return the name that the files of a build get.

    Examples
    --------
    >>> asset_name("examples/house.obj")
    'house'
    """
    if isinstance(asset, str | os.PathLike):
        return as_text(Path(asset).stem)
    if isinstance(asset, Scene):
        return as_text(asset.name)
    from voxrt.sources.from_trimesh import is_trimesh  # noqa: PLC0415 - files do not need it

    if is_trimesh(asset):
        return as_text(Path(str(asset.metadata.get("name") or asset.metadata.get("file_name") or "mesh")).stem)
    return "mesh"


def asset_label(asset: Asset) -> str:
    """Return what errors call an asset: the file's path as it was given, else its name.

    Examples
    --------
    >>> asset_label("examples/house.obj")
    'examples/house.obj'
    """
    return os.fspath(asset) if isinstance(asset, str | os.PathLike) else asset_name(asset)


def load_asset(asset: Asset, options: BuildOptions) -> Scene:
    """Load a file, or make a scene of what is in memory.

    Raises
    ------
    TypeError, ValueError
        The asset is nothing that can be built, or its arrays are not those of a mesh.
    AssetError
        The file cannot be read, is malformed, or says something that cannot be honoured.
    DoesNotFitError
        More than 255 materials.

    Examples
    --------
    >>> from voxrt import BuildOptions
    >>> load_asset("examples/house.obj", BuildOptions()).name
    'house'
    """
    if isinstance(asset, str | os.PathLike):
        return voxelize.load(
            Path(asset),
            up=options.up,
            unit=options.unit,
            time=options.time,
            animation=options.animation,
            variants=tuple(options.variants),
            allow_outside=options.allow_outside,
        )
    from voxrt.sources.from_arrays import mesh_scene  # noqa: PLC0415 - as above
    from voxrt.sources.from_trimesh import is_trimesh, trimesh_scene  # noqa: PLC0415

    unused = {"time": options.time, "animation": options.animation, "variants": options.variants}
    if isinstance(asset, Scene):
        scene, unused = asset, unused | {"up": options.up, "unit": options.unit}
    elif is_trimesh(asset):
        scene = trimesh_scene(asset, name=asset_name(asset), up=options.up, unit=options.unit)
    elif isinstance(asset, tuple) and len(asset) == 2:
        vertices, faces = asset
        scene = mesh_scene(vertices, faces, up=options.up, unit=options.unit)
    else:
        raise TypeError(
            "asset must be a file's path, a Scene, (vertices, faces), a trimesh.Trimesh or a trimesh.Scene, "
            f"not {type(asset).__name__}"
        )
    ignored = tuple(
        SceneWarning("ignored-option", f"{name} was ignored: it is for files that have it")
        for name, value in unused.items()
        if value not in (None, ())
    )
    return replace(scene, warnings=scene.warnings + ignored)


def as_text(name: str) -> str:
    r"""Return a name as text that can name files: what is no text, or a backslash, becomes ``_``.

    Examples
    --------
    >>> as_text("back\\slash")
    'back_slash'
    """
    text = os.fsencode(name).decode("utf-8", "replace")
    return text.translate({0xFFFD: "_", ord("\\"): "_"})


def refuse_warnings(asset: Asset, warnings: tuple[SceneWarning, ...], options: BuildOptions) -> None:
    """Refuse what a build warns of, if it is strict.

    Raises
    ------
    AssetError
        There is a warning; the message is that of the first.
    """
    if warnings and options.strict:
        first, *others = warnings
        kinds = sorted({warning.kind for warning in others})
        more = f"; and {len(others)} more ({', '.join(kinds)})" if others else ""
        raise AssetError(asset_label(asset), f"{first.message}{more}", fix="correct the asset, or build without strict")
