"""What a build starts from: an asset, opened once. Later steps ask the source and not the asset."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias, Union, cast

from msgspec import Struct
from msgspec.structs import replace

from voxrt import voxelize
from voxrt.sources.object_selection import named_camera, without_objects
from voxrt.voxelize import AssetError, Scene, SceneWarning
from voxrt.voxelize.formats.external_files import as_text, asset_name

if TYPE_CHECKING:
    import trimesh
    from numpy.typing import ArrayLike

    from voxrt.options.build_options import BuildOptions

Asset: TypeAlias = Union[
    str, "os.PathLike[str]", Scene, "tuple[ArrayLike, ArrayLike]", "trimesh.Trimesh", "trimesh.Scene"
]
"""A file's path; a scene; vertices (V, 3) and faces (F, 3); a mesh or a scene of trimesh."""


class Source(Struct, frozen=True, eq=False):
    """An asset that is opened, and the options of its build.

    Examples
    --------
    >>> from voxrt import BuildOptions
    >>> source = open_source("examples/house.obj", BuildOptions())
    >>> source.name, source.label, source.load().name
    ('house', 'examples/house.obj', 'house')
    """

    options: BuildOptions  # how the asset is loaded and built
    name: str  # what the files of the build are called
    label: str  # what errors call the asset: the path of its file as it was given, else its name
    file: Path | None = None  # None for an asset in memory
    value: object = None  # the asset in memory; None for a file

    @property
    def file_name(self) -> str | None:
        """The name of the file as text; None for an asset in memory."""
        return None if self.file is None else as_text(self.file.name)

    def load(self) -> Scene:
        """Load the scene, without the objects that the options ignore and with those joined that are filled together.

        TypeError or ValueError if arrays are not those of a mesh; AssetError if the file cannot be read or
        honoured; DoesNotFitError for more than 255 materials.
        """
        options = self.options
        scene = without_objects(self.label, self._whole_scene(), options.ignore)
        return voxelize.join_open_objects(scene) if options.fill == "together" else scene

    def with_camera(self, scene: Scene) -> Scene:
        """Return a scene with the author's camera that the options name; AssetError if it has no such camera."""
        name = self.options.camera
        return scene if name is None else replace(scene, viewpoint=named_camera(self.label, scene, name))

    def refuse_warnings(self, warnings: tuple[SceneWarning, ...]) -> None:
        """Raise AssetError with the first of the warnings, if there is one and the options are strict."""
        if warnings and self.options.strict:
            first, *others = warnings
            kinds = sorted({warning.kind for warning in others})
            more = f"; and {len(others)} more ({', '.join(kinds)})" if others else ""
            raise AssetError(self.label, f"{first.message}{more}", fix="correct the asset, or build without strict")

    def _whole_scene(self) -> Scene:
        options = self.options
        if self.file is None:
            return self._value_scene()
        return voxelize.load(
            self.file,
            up=options.up,
            unit=options.unit,
            time=options.time,
            animation=options.animation,
            variants=tuple(options.variants),
            opaque_from=options.opaque_from,
            points=options.points,
            allow_outside=options.allow_outside,
        )

    def _value_scene(self) -> Scene:
        from voxrt.voxelize.from_arrays import mesh_scene  # noqa: PLC0415 - files do not need it
        from voxrt.voxelize.from_trimesh import is_trimesh, trimesh_scene  # noqa: PLC0415

        value, options = self.value, self.options
        unused = {name: getattr(options, name) for name in ("time", "animation", "variants", "opaque_from", "points")}
        if isinstance(value, Scene):
            scene, unused = value, unused | {"up": options.up, "unit": options.unit}
        elif is_trimesh(value):
            scene = trimesh_scene(value, name=self.name, up=options.up, unit=options.unit)
        else:
            vertices, faces = cast("tuple[ArrayLike, ArrayLike]", value)
            scene = mesh_scene(vertices, faces, up=options.up, unit=options.unit)
        ignored = tuple(
            SceneWarning("ignored-option", f"{name} was ignored: it is for files that have it")
            for name, option in unused.items()
            if option not in (None, ())
        )
        return replace(scene, warnings=scene.warnings + ignored)


def open_source(asset: Asset, options: BuildOptions) -> Source:
    """Open an asset; TypeError if it is none. Nothing is read before :meth:`Source.load`."""
    if isinstance(asset, str | os.PathLike):
        return Source(options, asset_name(Path(asset)), os.fspath(asset), file=Path(asset))
    name = "mesh"
    if isinstance(asset, Scene):
        name = as_text(asset.name)
    else:
        from voxrt.voxelize.from_trimesh import is_trimesh  # noqa: PLC0415 - files do not need it

        if is_trimesh(asset):
            name = as_text(Path(str(asset.metadata.get("name") or asset.metadata.get("file_name") or name)).stem)
        elif not (isinstance(asset, tuple) and len(asset) == 2):
            raise TypeError(
                "asset must be a file's path, a Scene, a mesh or a scene of trimesh, or a tuple (vertices, faces), "
                f"not {type(asset).__name__}; for arrays: build((vertices, faces)), or voxelize_mesh(vertices, faces)"
            )
    return Source(options, name, name, value=asset)
