"""A ROM as the pair NAME.mem and NAME.json, and back; NAME.coe, NAME.mif and NAME.bin in place of the ``.mem`` alike.

The pair changes at one moment, the renaming of the new ``.mem``: before it, the new manifest waits under a temporary
name; after it, that file takes the name NAME.json. A reader takes whichever manifest has the CRC-32 of the ``.mem``,
and reads again if files changed meanwhile. So it finds the old pair or the new one at any time, and a ``.mem`` that was
exchanged alone is noticed.
"""

from __future__ import annotations

import errno
from pathlib import Path
from typing import TYPE_CHECKING

from voxrt.export.atomic import new_folder, staged_files, write_together
from voxrt.export.blob import Blob
from voxrt.export.manifest import make_manifest, manifest_bytes, read_manifest
from voxrt.export.palette import default_materials
from voxrt.export.provenance import Provenance
from voxrt.export.word_file import WORD_SUFFIXES, format_words, mem_crc32, read_word_file
from voxrt.octree import Octree, Rom, RomError, census, check_roots, decode, detect_dialect, encode, with_means
from voxrt.octree.dialects import as_dialect
from voxrt.voxelize import SceneWarning
from voxrt.voxelize.arguments import choice, instance
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    import numpy as np
    from numpy.typing import NDArray

    from voxrt.export.manifest import Manifest
    from voxrt.export.provenance import BakedLight, Source
    from voxrt.export.word_file import WordFile
    from voxrt.octree import Animation
    from voxrt.octree.camera import Camera, Lighting
    from voxrt.voxelize import ObjectReport


class RomFiles(Value, frozen=True):
    """Where a ROM was written: its words (a ``.mem``, most often) and its manifest."""

    mem: Path
    manifest: Path


def write_rom(
    folder: Path,
    rom: Rom,
    *,
    stem: str | None = None,
    suffix: str = ".mem",
    dialect: str = "report",
    objects: tuple[ObjectReport, ...] = (),
    warnings: tuple[SceneWarning, ...] = (),
    seconds: Mapping[str, float] | None = None,
    source: Source | None = None,
    view: Camera | None = None,
    lighting: Lighting | None = None,
    baked: BakedLight | None = None,
    animation: Animation | None = None,
    beside: Mapping[Path, bytes | None] | None = None,
) -> RomFiles:
    """Write ``folder/NAME.mem`` and ``folder/NAME.json``. An interruption leaves the old pair or the new one.

    Parameters
    ----------
    folder
        The folder. It is made if it is missing.
    rom
        The memory.
    stem
        The name of the files without their suffixes; None for the memory's name.
    suffix
        The kind of the file of words, one of :data:`WORD_SUFFIXES`.
    dialect
        How the file encodes materials, one of :data:`voxrt.octree.DIALECTS`. A memory without mean materials gets some
        for ``"lod"``.
    objects, warnings, seconds, source
        What the manifest says of the build.
    view, lighting
        The camera and the lighting that the manifest names.
    baked
        The light that was baked into the materials.
    animation
        The table of roots of a memory that holds the frames of an animation.
    beside
        The bytes of further files that belong to the pair, such as a preview: all of the files change or none. None
        for the bytes removes a file.

    Returns
    -------
    RomFiles
        The two files.

    Raises
    ------
    TypeError, ValueError
        The memory is none, its name or `stem` cannot name a file, or there is no such dialect or suffix.
    DoesNotFitError
        The dialect cannot name a material in use.
    OSError
        The folder cannot be written to, or ``NAME.json`` is there and is no manifest.

    Examples
    --------
    >>> import voxrt
    >>> from pathlib import Path
    >>> rom = voxrt.build("examples/house.obj", depth=4).rom
    >>> write_rom(Path("out"), rom).mem.name
    'house.mem'
    """
    known = Provenance(source, objects, warnings, dict(seconds or {}), baked)
    blob = Blob(instance("rom", rom, Rom), view, lighting, known, animation)
    return write_words(folder, rom.name if stem is None else stem, suffix, blob, dialect, beside=beside)


def write_words(
    folder: Path, stem: str, suffix: str, blob: Blob, dialect: str, *, beside: Mapping[Path, bytes | None] | None = None
) -> RomFiles:
    """Write as :func:`write_rom` does, with what the blob says besides the memory in the manifest."""
    choice("suffix", suffix.lower(), WORD_SUFFIXES)
    rom = blob.rom
    if stem in {"", ".", ".."} or any(c in stem for c in "/\0") or (stem == rom.name and "\\" in stem):
        raise ValueError(f"{stem!r} cannot name a file")
    words = _encoded(rom, dialect, blob.animation)
    manifest = make_manifest(blob, mem_crc32(words), as_dialect(dialect))
    files = RomFiles(folder / f"{stem}{suffix}", folder / f"{stem}.json")
    with new_folder(folder):
        _refuse_foreign(files.manifest)
        contents: dict[Path, bytes | Iterable[bytes] | None] = {
            files.mem: format_words(words, suffix.lower()),
            files.manifest: manifest_bytes(manifest),
        }
        write_together(contents | dict(beside or {}))
    return files


def words_crc32(rom: Rom, dialect: str, animation: Animation | None = None) -> str:
    """Return the CRC-32 by which a manifest knows the words of a memory in a dialect."""
    return f"{mem_crc32(_encoded(rom, dialect, animation)):08X}"


def _encoded(rom: Rom, dialect: str, animation: Animation | None) -> NDArray[np.uint32]:
    """Give the words in a dialect; for ``lod``, of a memory without mean materials too."""
    if dialect == "lod" and rom.octree.means is None:
        rom = with_means(rom, animation.roots if animation else (0,))
    return encode(rom.octree.words, dialect, rom.octree.means)


def other_words(path: Path, manifest: Manifest) -> Path | None:
    """Find another file of words, ``NAME`` with another suffix, that a manifest beside `path` describes."""
    for suffix in WORD_SUFFIXES:
        other = path.with_suffix(suffix)
        if suffix == path.suffix.lower() or not other.is_file():
            continue
        try:
            if _fits(manifest, read_word_file(other)):
                return other
        except RomError:  # damaged: nobody misses its manifest
            continue
    return None


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
        The memory. That of an animation has the root of the first frame; :func:`read_any` returns its frames, too.
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
    """Read as :func:`read_rom` does, with the camera, the lighting and the animation that the manifest names."""
    if mem_path.suffix.lower() not in WORD_SUFFIXES:
        raise RomError(f"{mem_path}: is no file of octree words; name one that ends in {', '.join(WORD_SUFFIXES)}")
    mem, manifest = _read_pair(mem_path)
    if manifest is None:
        rom, warnings = _without_manifest(mem_path, mem, depth, dialect)
        return Blob(rom), warnings
    for name, recorded, wanted in (("depth", manifest.depth, depth), ("dialect", manifest.dialect, dialect)):
        if wanted is not None and wanted != recorded:
            raise RomError(
                f"{mem_path}: the manifest says {name} {recorded}, and {wanted} was asked for; leave --{name} out"
            )
    octree = decode(mem.words, manifest.dialect, manifest.depth, source=str(mem_path), lines=mem.lines)
    animation = manifest.animation
    highest = check_roots(octree, animation.roots, source=str(mem_path)) if animation else _highest_material(octree)
    if octree.means is not None:
        highest = max(highest, int(octree.means.max(initial=0)))
    if highest >= len(manifest.materials):
        raise RomError(
            f"{mem_path}: material {highest} is missing from the manifest, which ends at "
            f"{len(manifest.materials) - 1}; build it again"
        )
    rom = Rom(manifest.name, octree, manifest.material_table, manifest.grid)
    return Blob(rom, manifest.view, manifest.lighting, manifest.provenance, animation), ()


def _read_pair(mem_path: Path) -> tuple[WordFile, Manifest | None]:
    """Read the words and the manifest that belongs to them; None where there is no manifest at all.

    A writer may put the next pair in place meanwhile: where the two do not fit and have changed, they are read again.
    """
    path = mem_path.with_suffix(".json")
    while True:
        before = _state(mem_path, path)
        mem = read_word_file(mem_path)
        manifest, problem = _manifest_of(path, mem)
        if manifest is not None:
            return mem, manifest
        if _state(mem_path, path) != before:
            continue
        if problem is not None:
            raise problem
        if before[1] is None:
            return mem, None
        raise RomError(
            f"{path}: describes another {mem_path.name} (CRC-32 {mem.crc32:08X} is not the one it names); "
            "build both again, or move the manifest away"
        )


def _manifest_of(path: Path, mem: WordFile) -> tuple[Manifest | None, RomError | None]:
    """Find the manifest of the words, by its name or one that waits for it; else say what is wrong with the former."""
    problem = None
    for candidate in (path, *staged_files(path)):
        try:
            if candidate.is_file() and _fits(manifest := read_manifest(candidate), mem):
                return manifest, None
        except RomError as error:
            problem = error if candidate == path else problem  # what waits may not be complete yet
    return None, problem


def _fits(manifest: Manifest, mem: WordFile) -> bool:
    return manifest.crc32 == f"{mem.crc32:08X}" and manifest.words == len(mem.words)


def _state(*paths: Path) -> tuple[tuple[int, int, int] | None, ...]:
    """Tell files from those that take their places."""
    found: list[tuple[int, int, int] | None] = []
    for path in paths:
        try:
            status = path.stat()
            found.append((status.st_ino, status.st_mtime_ns, status.st_size))
        except OSError:
            found.append(None)
    return tuple(found)


def _refuse_foreign(manifest: Path) -> None:
    """Refuse to replace a ``.json`` that says nothing of a memory: it is somebody's own."""
    if manifest.is_file() and (data := manifest.read_bytes()).strip() and b'"crc32"' not in data:
        raise FileExistsError(errno.EEXIST, f"{manifest.name} is there and is no manifest of a memory", str(manifest))


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
    return Rom(path.stem, octree, default_materials(_highest_material(octree))), tuple(warnings)


def _highest_material(octree: Octree) -> int:
    return max(census(octree).voxels)
