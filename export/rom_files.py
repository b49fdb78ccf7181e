"""A ROM as the pair NAME.mem and NAME.json, and back; NAME.coe, NAME.mif and NAME.bin in place of the ``.mem`` alike.

The pair changes at one moment, the renaming of the new ``.mem``: before it, the new manifest waits as NAME.json.next;
after it, that file takes the name NAME.json. A reader takes whichever of the two manifests has the CRC-32 of the
``.mem``, so an interruption at any point leaves the old pair or the new one, and a ``.mem`` that was exchanged alone is
noticed.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from voxrt.export.atomic import sync_folder, write_atomically
from voxrt.export.blob import Blob
from voxrt.export.coe import coe_bytes, read_coe
from voxrt.export.manifest import Source, make_manifest, manifest_bytes, read_manifest
from voxrt.export.mem import read_mem
from voxrt.export.mif import mif_bytes, read_mif
from voxrt.export.palette import default_materials
from voxrt.export.raw import raw_bytes, read_raw
from voxrt.export.word_file import mem_bytes
from voxrt.octree import Octree, Rom, RomError, census, decode, detect_dialect, encode
from voxrt.octree.dialects import as_dialect
from voxrt.voxelize import SceneWarning
from voxrt.voxelize.arguments import choice, instance

if TYPE_CHECKING:
    from collections.abc import Mapping

    from voxrt.export.manifest import BakedLight, Manifest
    from voxrt.export.word_file import WordFile
    from voxrt.octree.camera import Camera, Lighting
    from voxrt.voxelize import Material, ObjectReport


_READERS = {".mem": read_mem, ".coe": read_coe, ".mif": read_mif, ".bin": read_raw}
_WRITERS = {".mem": mem_bytes, ".coe": coe_bytes, ".mif": mif_bytes, ".bin": raw_bytes}

WORD_SUFFIXES = tuple(_WRITERS)
"""The files of words that are read and written."""


@dataclass(frozen=True, slots=True)
class RomFiles:
    """Where a ROM was written: its words (a ``.mem``, most often) and its manifest."""

    mem: Path
    manifest: Path


def write_rom(
    folder: Path,
    rom: Rom,
    *,
    suffix: str = ".mem",
    dialect: str = "report",
    objects: tuple[ObjectReport, ...] = (),
    warnings: tuple[SceneWarning, ...] = (),
    seconds: Mapping[str, float] | None = None,
    source: Source | None = None,
    view: Camera | None = None,
    lighting: Lighting | None = None,
    baked: BakedLight | None = None,
) -> RomFiles:
    """Write ``folder/NAME.mem`` and ``folder/NAME.json``. An interruption leaves the old pair or the new one.

    Parameters
    ----------
    folder
        The folder. It is made if it is missing.
    rom
        The memory. Its name names the files.
    suffix
        The kind of the file of words, one of :data:`WORD_SUFFIXES`.
    dialect
        How the file encodes materials, one of :data:`voxrt.octree.DIALECTS`.
    objects, warnings, seconds, source
        What the manifest says of the build.
    view, lighting
        The camera and the lighting that the manifest names.
    baked
        The light that was baked into the materials.

    Returns
    -------
    RomFiles
        The two files.

    Raises
    ------
    TypeError, ValueError
        The memory is none, its name cannot name a file, or there is no such dialect or suffix.
    DoesNotFitError
        The dialect cannot name a material in use.
    OSError
        The folder cannot be written to.

    Examples
    --------
    >>> import voxrt
    >>> from pathlib import Path
    >>> rom = voxrt.build("examples/house.obj", depth=4).rom
    >>> write_rom(Path("out"), rom).mem.name
    'house.mem'
    """
    instance("rom", rom, Rom)
    choice("suffix", suffix.lower(), WORD_SUFFIXES)
    if rom.name in {"", ".", ".."} or any(c in rom.name for c in "/\\\0"):
        raise ValueError(f"{rom.name!r} cannot name a file")
    words = encode(rom.octree.words, dialect)
    manifest = make_manifest(
        rom,
        mem_bytes(words),
        as_dialect(dialect),
        objects=objects,
        warnings=warnings,
        seconds=seconds,
        source=source,
        view=view,
        lighting=lighting,
        baked=baked,
    )
    folder.mkdir(parents=True, exist_ok=True)
    files = RomFiles(folder / f"{rom.name}{suffix}", folder / f"{rom.name}.json")
    waiting = _waiting(files.manifest)
    write_atomically(waiting, manifest_bytes(manifest))
    write_atomically(files.mem, _WRITERS[suffix.lower()](words))
    waiting.replace(files.manifest)
    sync_folder(folder)
    return files


def read_rom(
    path: Path | str, depth: int | None = None, dialect: str | None = None
) -> tuple[Rom, tuple[SceneWarning, ...]]:
    """Read a ``.mem`` file, with the manifest beside it or without.

    Parameters
    ----------
    path
        ``NAME.mem``, or with another of :data:`WORD_SUFFIXES`. The manifest is ``NAME.json``.
    depth, dialect
        Needed only without a manifest. If they are not given either, the depth is the least that the memory needs, the
        leaves tell the dialect, the materials get default colours, and warnings say so.

    Returns
    -------
    rom
        The memory.
    warnings
        What was assumed.

    Raises
    ------
    RomError
        The memory or the manifest is malformed, they do not belong together, or `depth` or `dialect` contradicts the
        manifest.

    Examples
    --------
    >>> import voxrt
    >>> files = voxrt.build("examples/house.obj", "out", depth=4).outputs
    >>> rom, warnings = read_rom(files["mem"])
    >>> rom, warnings
    (<Rom 'house': depth 4, 721 words, 5 materials>, ())
    """
    blob, warnings = read_words(Path(path), depth, dialect)
    return blob.rom, warnings


def read_words(
    mem_path: Path, depth: int | None = None, dialect: str | None = None
) -> tuple[Blob, tuple[SceneWarning, ...]]:
    """Read as :func:`read_rom` does, with the camera and the lighting that the manifest names."""
    if mem_path.suffix.lower() not in _READERS:
        raise RomError(f"{mem_path}: is no file of octree words; name one that ends in {', '.join(WORD_SUFFIXES)}")
    mem = _READERS[mem_path.suffix.lower()](mem_path)
    manifest = _manifest_of(mem_path, mem)
    if manifest is None:
        rom, warnings = _without_manifest(mem_path, mem, depth, dialect)
        return Blob(rom), warnings
    for name, said, wanted in (("depth", manifest.depth, depth), ("dialect", manifest.dialect, dialect)):
        if wanted is not None and wanted != said:
            raise RomError(
                f"{mem_path}: the manifest says {name} {said}, and {wanted} was asked for; leave --{name} out"
            )
    octree = decode(mem.words, manifest.dialect, manifest.depth, source=str(mem_path), lines=mem.lines)
    highest = _highest_material(octree)
    if highest >= len(manifest.materials):
        raise RomError(
            f"{mem_path}: material {highest} is missing from the manifest, which ends at "
            f"{len(manifest.materials) - 1}; build it again"
        )
    rom = Rom(manifest.name, octree, manifest.material_table, manifest.grid)
    return Blob(rom, manifest.view, manifest.lighting), ()


def _manifest_of(mem_path: Path, mem: WordFile) -> Manifest | None:
    """Find the manifest that belongs to the bytes of the ``.mem``; None where there is no manifest at all."""
    path = mem_path.with_suffix(".json")
    candidates = [candidate for candidate in (path, _waiting(path)) if candidate.is_file()]
    for candidate in candidates:
        manifest = read_manifest(candidate)
        if manifest.crc32 == f"{mem.crc32:08X}" and manifest.words == len(mem.words):
            return manifest
    if path in candidates:
        raise RomError(
            f"{path}: describes another {mem_path.name} (CRC-32 {mem.crc32:08X} is not the one it names); "
            "build both again, or move the manifest away"
        )
    return None


def _waiting(manifest: Path) -> Path:
    return manifest.with_name(f"{manifest.name}.next")


def _without_manifest(
    path: Path, mem: WordFile, depth: int | None, dialect: str | None
) -> tuple[Rom, tuple[SceneWarning, ...]]:
    warnings: list[SceneWarning] = []
    if dialect is None:
        dialect = detect_dialect(mem.words, source=str(path), lines=mem.lines)
        warnings.append(
            SceneWarning("assumed-dialect", f"{path.name} has no manifest; its leaves are those of {dialect}")
        )
    octree = decode(mem.words, dialect, depth, source=str(path), lines=mem.lines)
    if depth is None:
        message = f"{path.name} has no manifest; depth {octree.depth} is the least that its words have"
        warnings.append(SceneWarning("assumed-depth", message))
    warnings.append(SceneWarning("assumed-palette", f"{path.name} has no manifest; its materials have default colours"))
    return Rom(path.stem, octree, _palette(octree)), tuple(warnings)


def _palette(octree: Octree) -> tuple[Material, ...]:
    return default_materials(_highest_material(octree))


def _highest_material(octree: Octree) -> int:
    return max(census(octree).voxels)
