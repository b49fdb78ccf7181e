"""What a build made."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from msgspec import field

from voxrt import export, octree
from voxrt.options.shared import PREVIEW_SIZE
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    import os

    import numpy as np
    from numpy.typing import NDArray

    from voxrt.building.fitting import BudgetFit, InteriorFit
    from voxrt.export import BakedLight, Blob, Source
    from voxrt.octree import Animation, Octree, Rom
    from voxrt.octree.camera import Camera, Lighting
    from voxrt.views.pictures import Picture
    from voxrt.voxelize import ObjectReport, Scene, SceneWarning


class BuildResult(Value, frozen=True, eq=False):
    """What a build made. A notebook shows its picture.

    Attributes
    ----------
    rom
        The octree memory with its materials and its place in the scene.
    scene
        What the asset said.
    objects
        How each object was voxelized, in authored order.
    warnings
        What the asset said and the build did not honour as it stands.
    outputs
        The files written, by kind: ``"mem"``, ``"manifest"``, ``"preview"``.
    preview
        The rendered picture; None if none was asked for.
    interior
        What became of hidden voxels; None if they keep their materials.
    budget
        What fitting the budget took; None if there was none.
    seconds
        Wall seconds per stage, in order: ``"load"``, ``"fit"``, ``"colour"``, ``"voxelize"``, ``"octree"``,
        ``"bake"``, ``"interior"``, ``"budget"``, ``"write"``, ``"preview"``.
    parts
        Wall seconds per part of a stage: those of ``"voxelize"`` (:attr:`voxrt.voxelize.Voxelization.seconds`).
    view, lighting
        The author's camera and light; None if the author gave none. A memory with baked light is shown flat.
    source
        The name of the asset, and the options of the build.
    bake
        What was baked; None if no light was.
    animation
        The table of roots of a memory that holds the frames of an animation; None for a memory of one scene. `rom`,
        `objects`, `solid_voxels` and the arrays are then those of the first frame.

    Examples
    --------
    >>> import voxrt
    >>> built = voxrt.build("examples/house.obj", depth=4)
    >>> built
    <BuildResult 'house': depth 4, 721 words, 2,504 solid voxels, 5 materials>
    >>> built.coordinates.shape
    (2504, 3)
    >>> built.to_dense().shape
    (16, 16, 16)
    >>> built.save("house.png")
    """

    rom: Rom
    scene: Scene
    objects: tuple[ObjectReport, ...]
    warnings: tuple[SceneWarning, ...]
    outputs: dict[str, Path] = field(default_factory=dict)
    preview: Picture | None = None
    interior: InteriorFit | None = None
    budget: BudgetFit | None = None
    seconds: dict[str, float] = field(default_factory=dict)
    parts: dict[str, dict[str, float]] = field(default_factory=dict)
    view: Camera | None = None
    lighting: Lighting | None = None
    source: Source | None = None
    bake: BakedLight | None = None
    animation: Animation | None = None

    def __repr__(self) -> str:
        words, count = len(self.octree.words), len(self.rom.materials) - 1
        frames = "" if self.animation is None else f"{len(self.animation.frames)} frames, "
        files = "".join(f", {path}" for path in self.outputs.values())
        return (
            f"<BuildResult {self.rom.name!r}: {frames}depth {self.octree.depth}, {words:,} words, "
            f"{self.solid_voxels:,} solid voxels, {count} {'material' if count == 1 else 'materials'}{files}>"
        )

    def _repr_png_(self) -> bytes:
        return self.picture._repr_png_()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the picture, as a PNG file, or the memory, in the form that the suffix of the file asks for.

        Parameters
        ----------
        path
            The file: ``.png``, or a suffix of :data:`voxrt.WRITABLE_SUFFIXES`, as :func:`voxrt.convert` takes it.

        Raises
        ------
        RomError
            The suffix is another.
        OutputError
            The file cannot be written.
        """
        from voxrt.views.writers import convert  # noqa: PLC0415 - slow to import

        if Path(path).suffix.lower() == ".png":
            self.picture.save(path)
        else:
            convert(self.blob, path)

    def show(self) -> None:
        """Show the picture as :meth:`Frame.show` does."""
        self.picture.show()

    @property
    def picture(self) -> Picture:
        """The preview; without one, a picture that the model renders for this call."""
        from voxrt.views.pictures import animation_camera, preview  # noqa: PLC0415 - as above

        return self.preview or preview(self.blob, animation_camera(self.blob, PREVIEW_SIZE))

    @property
    def blob(self) -> Blob:
        """The memory with all that its files say, as :func:`voxrt.convert` takes it."""
        provenance = export.Provenance(self.source, self.objects, self.warnings, self.seconds, self.bake)
        return export.Blob(self.rom, self.view, self.lighting, provenance, self.animation)

    @property
    def baked(self) -> BakedLight | None:
        """The light that was baked, as the manifest tells it; None if no light was."""
        return self.bake

    @property
    def octree(self) -> Octree:
        """The octree memory."""
        return self.rom.octree

    @property
    def solid_voxels(self) -> int:
        """The number of voxels that are not empty."""
        return octree.census(self.rom.octree).solid_voxels

    @property
    def coordinates(self) -> NDArray[np.int32]:
        """The solid voxels: int32, shape (N, 3), grid frame, in Morton order. :func:`voxrt.octree.to_points`."""
        return octree.to_points(self.rom.octree)[0]

    @property
    def material_ids(self) -> NDArray[np.uint8]:
        """The materials of `coordinates`: uint8, shape (N,), rows of ``rom.materials``."""
        return octree.to_points(self.rom.octree)[1]

    def to_dense(self) -> NDArray[np.uint8]:
        """Return material ids voxel by voxel: uint8, shape (S, S, S), indexed [x, y, z]; S = 2**depth, 0 is empty.

        Raises
        ------
        DoesNotFitError
            The array would take more than 2 GiB; :func:`voxrt.octree.to_dense` returns a part of it.
        """
        return octree.to_dense(self.rom.octree)
