"""The manifest: what a ``.mem`` file cannot say about itself, as JSON beside it.

Every field is required except the camera, the lighting and the baked light. No other field is allowed. A reader refuses
a schema version that it does not know.
"""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - msgspec resolves the annotations of this module
from typing import TYPE_CHECKING

import msgspec

from voxrt.export.atomic import write_atomically
from voxrt.export.provenance import BakedLight, Provenance, Source
from voxrt.octree import Animation, Dialect, RomError, census
from voxrt.octree.camera import Camera, Lighting  # noqa: TC001 - msgspec resolves the annotations of this module
from voxrt.octree.rom import MOST_NAME
from voxrt.voxelize import Grid, Material, ObjectReport, SceneWarning

if TYPE_CHECKING:
    from voxrt.export.blob import Blob

SCHEMA_VERSION = 1


class MaterialEntry(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A row of the material table: :class:`~voxrt.voxelize.Material`, its id, and the voxels that have it."""

    id: int
    name: str
    colour: tuple[int, int, int]
    mirror: bool
    authored: bool
    voxels: int


class World(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Where the voxels stand: `matrix` (rows, for column vectors) maps voxel coordinates to the scene frame, metres."""

    origin: tuple[float, float, float]
    voxel_size: float
    matrix: tuple[
        tuple[float, float, float, float],
        tuple[float, float, float, float],
        tuple[float, float, float, float],
        tuple[float, float, float, float],
    ]


class Manifest(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What stands in ``NAME.json`` beside ``NAME.mem``.

    Attributes
    ----------
    schema
        :data:`SCHEMA_VERSION`.
    name
        The memory's name.
    words, blocks
        Sizes of the memory.
    depth
        Levels: the world is 2**depth voxels per side.
    dialect
        How the ``.mem`` marks its leaves.
    crc32
        CRC-32 of the bytes of the ``.mem``, 8 hex digits: ties the two files together.
    voxels
        Solid voxels.
    materials
        The material table by id; entry 0 is empty space with the background's colour.
    world
        Where the voxels stand; null where that is not known.
    objects
        How each object was voxelized, in authored order.
    warnings
        What the asset said and the build did not honour as it stands.
    seconds
        Wall seconds per stage.
    source
        What it was built from; null where that is not known.
    view, lighting
        The author's camera and light; null, or absent, where the author gave none.
    baked
        The light that was baked into the materials; null, or absent, where none was.
    animation
        The frames of an animation and their roots; null, or absent, for a memory of one scene. Voxels and objects are
        then those of the first frame.
    """

    schema: int
    name: str
    words: int
    blocks: int
    depth: int
    dialect: Dialect
    crc32: str
    voxels: int
    materials: tuple[MaterialEntry, ...]
    world: World | None
    objects: tuple[ObjectReport, ...]
    warnings: tuple[SceneWarning, ...]
    seconds: dict[str, float]
    source: Source | None
    view: Camera | None = None
    lighting: Lighting | None = None
    baked: BakedLight | None = None
    animation: Animation | None = None

    @property
    def material_table(self) -> tuple[Material, ...]:
        """The materials as the rest of the project passes them, indexed by id."""
        return tuple(Material(entry.name, entry.colour, entry.mirror, entry.authored) for entry in self.materials)

    @property
    def provenance(self) -> Provenance:
        """What it says of the build."""
        return Provenance(self.source, self.objects, self.warnings, self.seconds, self.baked)

    @property
    def grid(self) -> Grid | None:
        """Where the voxels stand in the scene; None where that is not known."""
        return None if self.world is None else Grid(self.depth, self.world.origin, self.world.voxel_size)


def make_manifest(blob: Blob, crc32: int, dialect: Dialect) -> Manifest:
    """Return the manifest of a memory whose ``.mem`` file has the CRC-32 `crc32`."""
    rom, known = blob.rom, blob.provenance
    counts = census(rom.octree)
    voxels = counts.voxels
    return Manifest(
        schema=SCHEMA_VERSION,
        name=rom.name,
        words=len(rom.octree.words),
        blocks=rom.octree.blocks,
        depth=rom.octree.depth,
        dialect=dialect,
        crc32=f"{crc32:08X}",
        voxels=counts.solid_voxels,
        materials=tuple(
            MaterialEntry(i, entry.name, entry.colour, entry.mirror, entry.authored, voxels.get(i, 0))
            for i, entry in enumerate(rom.materials)
        ),
        world=None if rom.grid is None else _world(rom.grid),
        objects=known.objects,
        warnings=known.warnings,
        seconds=known.seconds,
        source=known.source,
        view=blob.view,
        lighting=blob.lighting,
        baked=known.baked,
        animation=blob.animation,
    )


def manifest_bytes(manifest: Manifest) -> bytes:
    """Return a manifest as the bytes of a ``.json`` file."""
    return msgspec.json.format(msgspec.json.encode(manifest), indent=2) + b"\n"


def write_manifest(path: Path, manifest: Manifest) -> None:
    """Write a manifest. An interruption leaves the old file or the new one.

    Raises
    ------
    OSError
        The file cannot be written.

    Examples
    --------
    >>> import voxrt
    >>> files = voxrt.build("examples/house.obj", "out", depth=4).outputs
    >>> write_manifest(files["manifest"], read_manifest(files["manifest"]))
    """
    write_atomically(path, manifest_bytes(manifest))


def read_manifest(path: Path) -> Manifest:
    """Read a manifest.

    Raises
    ------
    RomError
        The file cannot be read, is not JSON, breaks the schema, or contradicts itself. The message names the field.

    Examples
    --------
    >>> import voxrt
    >>> files = voxrt.build("examples/house.obj", "out", depth=4).outputs
    >>> read_manifest(files["manifest"]).voxels
    2504
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise RomError(f"{path}: cannot be read: {error.strerror}; name a manifest") from None
    try:
        str(data, "utf-8")  # the decoder looks only at the strings it needs
        version = msgspec.json.decode(data, type=_Version).schema
        if version != SCHEMA_VERSION:
            raise RomError(f"{path}: schema {version} is not known to this version ({SCHEMA_VERSION}); upgrade voxrt")
        manifest = msgspec.json.decode(data, type=Manifest)
    except msgspec.MsgspecError as error:
        raise RomError(f"{path}: {error}; it is no manifest of a memory, or damaged: build it again") from None
    except UnicodeDecodeError as error:
        raise RomError(f"{path}: byte {error.start} is no UTF-8; the manifest is damaged: build it again") from None
    except RecursionError:
        raise RomError(f"{path}: nested too deeply to be a manifest; build it again") from None
    _check(path, manifest)
    return manifest


class _Version(msgspec.Struct):
    schema: int


def _world(grid: Grid) -> World:
    x, y, z = grid.origin
    size = grid.voxel_size
    return World(grid.origin, size, ((size, 0, 0, x), (0, size, 0, y), (0, 0, size, z), (0, 0, 0, 1)))


def _check(path: Path, manifest: Manifest) -> None:
    def refuse(field: str, problem: str) -> None:
        raise RomError(f"{path}: $.{field}: {problem}; build it again")

    if len(manifest.name) > MOST_NAME:
        refuse("name", f"{len(manifest.name)} characters are no name; it may have {MOST_NAME}")
    if not 1 <= manifest.depth <= 16:
        refuse("depth", f"{manifest.depth} is outside 1 ... 16")
    if manifest.words != 1 + 8 * manifest.blocks:
        refuse("words", f"{manifest.words} are not a root and {manifest.blocks} blocks of 8")
    if not 1 <= len(manifest.materials) <= 256:
        refuse("materials", f"{len(manifest.materials)} entries are not 1 ... 256")
    for i, entry in enumerate(manifest.materials):
        if entry.id != i:
            refuse(f"materials[{i}].id", f"{entry.id} stands in row {i}")
        if not all(0 <= channel <= 255 for channel in entry.colour):
            refuse(f"materials[{i}].colour", f"{entry.colour} is outside 0 ... 255")
    if manifest.world is not None and not manifest.world.voxel_size > 0:
        refuse("world.voxel_size", f"{manifest.world.voxel_size} is not above 0")
