"""The blob: a whole scene in one file, for a board that reads no other.

``docs/blob.md`` describes it byte by byte, ``docs/voxrt_blob.h`` for C and ``docs/voxrt_blob.ksy`` for Kaitai Struct.
All numbers are little-endian. A header and a table name the sections, each with its CRC-32. A reader skips sections
that it does not know.
"""

from __future__ import annotations

import math
import struct
import zlib
from typing import TYPE_CHECKING

import msgspec
import numpy as np
from msgspec import field
from msgspec.structs import replace

from voxrt.export.atomic import write_atomically
from voxrt.export.provenance import Provenance
from voxrt.export.word_file import mapped_bytes
from voxrt.octree import Animation, AnimationFrame, Rom, RomError, census, check_roots, decode, frame_octree
from voxrt.octree.camera import BOUNCE_LIMIT, FACES, Camera, Faces, Lighting
from voxrt.octree.rom import MOST_NAME
from voxrt.voxelize import Grid, Material
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from mmap import mmap
    from pathlib import Path

MAGIC = b"VOXRTBLB"
VERSION = 1

_HEADER = struct.Struct("<8sIIII")  # magic, version, sections, bytes of the file, CRC-32 of the table
_ENTRY = struct.Struct("<4sIII")  # name, offset, bytes, CRC-32
_WORLD = struct.Struct("<II4d")  # depth, 1 where the grid is known, origin, voxel size
_MATERIAL = struct.Struct("<4BHxx")  # red, green, blue, flags, bytes of the name
_VIEW = struct.Struct("<12i")  # position, look, right, up
_LIGHT = struct.Struct("<3i4B")  # position, ambient, flags, bounces, 0
_FRAME = struct.Struct("<IIdHxxxxxx")  # root, words of the frame alone, second or NaN, bytes of the name
_FACES = struct.Struct("<6B")  # brightness of the faces along -x, +x, -y, +y, -z, +z; absent where it is the default

_MIRROR, _AUTHORED = 1, 2
_LIGHT_ON, _FLAT, _BY_ANGLE = 1, 2, 4


class Blob(Value, frozen=True, eq=False):
    """What a blob holds: a memory, and how it is to be seen.

    Attributes
    ----------
    rom
        The memory. The colour of material 0 is the background.
    view, lighting
        The camera and the lighting to start with; None leaves them to the board.
    provenance
        What the manifest says of the build. A blob keeps all of it but the seconds: equal memories give equal blobs.
    animation
        The table of roots of a memory that holds the frames of an animation; None for a memory of one scene. `rom` is
        that of the first frame, and :meth:`frame` gives the others.

    Examples
    --------
    >>> import voxrt
    >>> rom = voxrt.build("examples/house.obj", depth=4).rom
    >>> Blob(rom).lighting is None
    True
    """

    rom: Rom
    view: Camera | None = None
    lighting: Lighting | None = None
    provenance: Provenance = field(default_factory=Provenance)
    animation: Animation | None = None

    @property
    def roots(self) -> tuple[int, ...]:
        """The words that are the roots of the frames; (0,) for a memory of one scene."""
        return (0,) if self.animation is None else self.animation.roots

    def frame(self, number: int) -> Rom:
        """Return the memory whose root is that of a frame.

        Parameters
        ----------
        number
            The frame, counted from 0. A memory without animation has frame 0.

        Raises
        ------
        RomError
            There is no such frame.

        Examples
        --------
        >>> import voxrt
        >>> Blob(voxrt.build("examples/house.obj", depth=4).rom).frame(0)
        <Rom 'house': depth 4, 721 words, 5 materials>
        """
        roots = self.roots
        if not 0 <= number < len(roots):
            there = f"has frames 0 to {len(roots) - 1}" if self.animation else "is no animation: it has frame 0"
            raise RomError(f"{self.rom.name}: there is no frame {number}; the memory {there}")
        return replace(self.rom, octree=frame_octree(self.rom.octree, roots[number]))


def blob_bytes(blob: Blob) -> bytes:
    """Return a blob as the bytes of its file.

    Examples
    --------
    >>> import voxrt
    >>> blob_bytes(Blob(voxrt.build("examples/house.obj", depth=4).rom))[:8]
    b'VOXRTBLB'
    """
    rom = blob.rom
    sections = {
        b"NAME": rom.name.encode(),
        b"WRLD": _WORLD.pack(rom.octree.depth, *((1, *rom.grid.origin, rom.grid.voxel_size) if rom.grid else (0,) * 5)),
        b"MATL": struct.pack("<I", len(rom.materials)) + b"".join(_pack_material(entry) for entry in rom.materials),
        b"WORD": rom.octree.words.astype("<u4").tobytes(),
    }
    if view := blob.view:
        sections[b"VIEW"] = _VIEW.pack(*view.position, *view.look, *view.right, *view.up)
    if light := blob.lighting:
        flags = light.on * _LIGHT_ON | light.flat * _FLAT | (light.faces is None) * _BY_ANGLE
        sections[b"LITE"] = _LIGHT.pack(*light.position, light.ambient, flags, light.bounces, 0)
        if light.faces not in (None, FACES):
            sections[b"FACE"] = _FACES.pack(*light.faces)
    if blob.animation:
        frames = blob.animation.frames
        sections[b"FRMS"] = struct.pack("<I4x", len(frames)) + b"".join(_pack_frame(frame) for frame in frames)
    origin = msgspec.structs.replace(blob.provenance, seconds={})
    if origin != Provenance():
        sections[b"PROV"] = msgspec.json.encode(origin)
    offset = _HEADER.size + _ENTRY.size * len(sections)
    table, body = b"", b""
    for name, data in sections.items():
        table += _ENTRY.pack(name, offset + len(body), len(data), zlib.crc32(data))
        body += data + bytes(-len(data) % 8)
    return _HEADER.pack(MAGIC, VERSION, len(sections), offset + len(body), zlib.crc32(table)) + table + body


def write_blob(path: Path, blob: Blob) -> None:
    """Write a blob. An interruption leaves the old file or the new one.

    Raises
    ------
    OSError
        The file cannot be written.

    Examples
    --------
    >>> import voxrt
    >>> from pathlib import Path
    >>> write_blob(Path("house.blob"), Blob(voxrt.build("examples/house.obj", depth=4).rom))
    """
    write_atomically(path, blob_bytes(blob))


def read_blob(path: Path) -> Blob:
    """Read a blob. A large one is mapped, as :func:`read_raw` maps files.

    Raises
    ------
    RomError
        The file cannot be read, is damaged, or holds no valid octree. The message names the section.

    Examples
    --------
    >>> import voxrt
    >>> from pathlib import Path
    >>> path = Path("house.blob")
    >>> write_blob(path, Blob(voxrt.build("examples/house.obj", depth=4).rom))
    >>> read_blob(path).rom
    <Rom 'house': depth 4, 721 words, 5 materials>
    """
    sections = _sections(path, mapped_bytes(path))
    for name in (b"NAME", b"WRLD", b"MATL", b"WORD"):
        if name not in sections:
            raise _damaged(path, f"section {name.decode()}", "is missing")
    try:
        depth, known, *place = _WORLD.unpack(sections[b"WRLD"])
        view = _VIEW.unpack(sections[b"VIEW"]) if b"VIEW" in sections else None
        light = _LIGHT.unpack(sections[b"LITE"]) if b"LITE" in sections else None
        faces = _FACES.unpack(sections[b"FACE"]) if b"FACE" in sections else FACES
        title = bytes(sections[b"NAME"]).decode()
    except (struct.error, UnicodeDecodeError):
        raise _damaged(
            path, "section NAME, WRLD, VIEW, LITE or FACE", "has another layout than that of version 1"
        ) from None
    if len(title) > MOST_NAME:
        raise _damaged(path, "section NAME", f"{len(title)} characters are no name; it may have {MOST_NAME}")
    words = sections[b"WORD"]
    if len(words) % 4:
        raise _damaged(path, "section WORD", f"{len(words)} bytes are not words of 4")
    aligned = np.require(np.frombuffer(words, "<u4").astype(np.uint32, copy=False), requirements="A")
    octree = decode(aligned, "report", depth, source=str(path))
    materials = _materials(path, bytes(sections[b"MATL"]))
    animation = _animation(path, bytes(sections[b"FRMS"])) if b"FRMS" in sections else None
    highest = check_roots(octree, animation.roots, source=str(path)) if animation else max(census(octree).voxels)
    if highest >= len(materials):
        raise _damaged(path, "section MATL", f"ends at material {len(materials) - 1} and {highest} is in use")
    return Blob(
        Rom(title, octree, materials, _grid(path, depth, place) if known else None),
        None if view is None else Camera(view[:3], view[3:6], view[6:9], view[9:]),
        None if light is None else _lighting(light, faces),
        _provenance(path, bytes(sections[b"PROV"])) if b"PROV" in sections else Provenance(),
        animation,
    )


def _sections(path: Path, whole: bytes | mmap) -> dict[bytes, memoryview]:
    data = memoryview(whole)
    if data[: len(MAGIC)] != MAGIC:
        raise RomError(f"{path}: does not start with {MAGIC.decode()}; name a blob")
    if len(data) < _HEADER.size:
        raise _damaged(path, "header", "is cut short")
    _, version, count, size, crc32 = _HEADER.unpack_from(data)
    if version != VERSION:
        raise RomError(f"{path}: blob version {version} is not known to this version ({VERSION}); upgrade voxrt")
    table = data[_HEADER.size : _HEADER.size + _ENTRY.size * min(count, len(data))]
    if size != len(data) or len(table) != _ENTRY.size * count or zlib.crc32(table) != crc32:
        raise _damaged(
            path, "header", f"speaks of {size} bytes and another table of sections than the {len(data)} here"
        )
    sections = {}
    for name, offset, length, section_crc32 in _ENTRY.iter_unpack(table):
        section = data[offset : offset + length]
        if len(section) != length or zlib.crc32(section) != section_crc32:
            raise _damaged(
                path, f"section {name.decode('latin-1').encode('unicode_escape').decode()}", "is damaged (CRC-32)"
            )
        sections[name] = section
    return sections


def _damaged(path: Path, place: str, problem: str) -> RomError:
    return RomError(f"{path}: {place}: {problem}; write the blob again")


def _cut(name: str) -> bytes:
    """Return as much of a name as its length of 16 bits can say."""
    return name.encode()[:0xFFFF].decode(errors="ignore").encode()


def _pack_material(material: Material) -> bytes:
    name = _cut(material.name)
    flags = material.mirror * _MIRROR | material.authored * _AUTHORED
    return _MATERIAL.pack(*material.colour, flags, len(name)) + name + bytes(-len(name) % 8)


def _materials(path: Path, section: bytes) -> tuple[Material, ...]:
    entries = []
    try:
        (count,) = struct.unpack_from("<I", section)
        position = 4
        if not 1 <= count <= 256:
            raise _damaged(path, "section MATL", f"{count} materials are not 1 ... 256")
        for _ in range(count):
            red, green, blue, flags, length = _MATERIAL.unpack_from(section, position)
            position += _MATERIAL.size
            name = section[position : position + length].decode()
            position += length + -length % 8
            entries.append(Material(name, (red, green, blue), bool(flags & _MIRROR), bool(flags & _AUTHORED)))
    except (struct.error, UnicodeDecodeError):
        raise _damaged(path, "section MATL", "is cut short or no text") from None
    return tuple(entries)


def _pack_frame(frame: AnimationFrame) -> bytes:
    name = _cut(frame.name)
    time = math.nan if frame.time is None else frame.time
    return _FRAME.pack(frame.root, frame.words, time, len(name)) + name + bytes(-len(name) % 8)


def _animation(path: Path, section: bytes) -> Animation:
    frames = []
    try:
        (count,) = struct.unpack_from("<I", section)
        position = 8
        if not 1 <= count <= len(section) // _FRAME.size:
            raise _damaged(path, "section FRMS", f"{count} frames are not what its {len(section)} bytes hold")
        for _ in range(count):
            root, words, time, length = _FRAME.unpack_from(section, position)
            position += _FRAME.size
            name = section[position : position + length].decode()
            position += length + -length % 8
            frames.append(AnimationFrame(root, words, None if math.isnan(time) else time, name))
    except (struct.error, UnicodeDecodeError, ValueError) as error:
        raise _damaged(path, "section FRMS", f"is no table of roots ({error})") from None
    return Animation(tuple(frames))


def _provenance(path: Path, section: bytes) -> Provenance:
    try:
        str(section, "utf-8")  # the decoder looks only at the strings it needs
        return msgspec.json.decode(section, type=Provenance)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        raise _damaged(path, "section PROV", f"is no account of a build ({error})") from None


def _grid(path: Path, depth: int, place: list[float]) -> Grid:
    x, y, z, voxel_size = place
    if not all(map(np.isfinite, place)) or voxel_size <= 0:
        raise _damaged(path, "section WRLD", "the grid stands nowhere")
    return Grid(depth, (x, y, z), voxel_size)


def _lighting(fields: tuple[int, ...], faces: Faces) -> Lighting:
    x, y, z, ambient, flags, bounces, _ = fields
    return Lighting(
        (x, y, z),
        ambient,
        on=bool(flags & _LIGHT_ON),
        flat=bool(flags & _FLAT),
        bounces=min(bounces, BOUNCE_LIMIT),
        faces=None if flags & _BY_ANGLE else faces,
    )
