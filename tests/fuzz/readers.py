"""What is fuzzed: each reader, how bytes become the files it reads, sound files to begin with, and what must hold.

A reader's input is one string of bytes. Where a reader reads two files, or one with checksums that hardly any change
would survive, its `write` makes them of the bytes: a fuzzer that had to guess checksums would see their check alone.
"""

from __future__ import annotations

import json
import struct
import zipfile
import zlib
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from oracles.gltf_writer import glb_of
from oracles.rich_gltf import rich
from oracles.sound_scenes import assert_sound

from voxrt import export, octree, voxelize
from voxrt.octree.camera import Camera, Lighting

if TYPE_CHECKING:
    from collections.abc import Callable

REFUSALS = (voxelize.AssetError, voxelize.DoesNotFitError, octree.RomError)
"""All that a reader may raise."""

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
_BETWEEN = b"\0\0"  # the first file of an input, and the second


@dataclass(frozen=True, slots=True)
class Reader:
    """A reader under test.

    Attributes
    ----------
    write
        Makes an input's files in a folder and returns the one to read.
    read
        Reads it and checks what it gives; raises one of :data:`REFUSALS` alone.
    seeds
        Inputs that are read.
    tokens
        Words of the format, for inputs to be made of.
    suffixes
        Which files are inputs as they stand.
    """

    write: Callable[[Path, bytes], Path]
    read: Callable[[Path], None]
    seeds: tuple[bytes, ...]
    tokens: tuple[bytes, ...] = ()
    suffixes: tuple[str, ...] = ()

    def run(self, folder: Path, data: bytes) -> bool:
        """Read an input; False where it is refused, which takes one line."""
        path = self.write(folder, data)
        try:
            self.read(path)
        except REFUSALS as error:
            assert "\n" not in str(error), str(error)  # noqa: PT017 -- and no other error comes
            return False
        return True


def _as(name: str) -> Callable[[Path, bytes], Path]:
    def write(folder: Path, data: bytes) -> Path:
        path = folder / name
        path.write_bytes(data)
        return path

    return write


def _zipped(name: str, part: str) -> Callable[[Path, bytes], Path]:
    def write(folder: Path, data: bytes) -> Path:
        with zipfile.ZipFile(folder / name, "w") as archive:
            archive.writestr(part, data)
        return folder / name

    return write


def _pair(first: str, second: str) -> Callable[[Path, bytes], Path]:
    def write(folder: Path, data: bytes) -> Path:
        one, _, other = data.partition(_BETWEEN)
        (folder / second).write_bytes(other)
        return _as(first)(folder, one)

    return write


def _glb(folder: Path, data: bytes) -> Path:
    """JSON, then the binary chunk."""
    text, _, binary = data.partition(_BETWEEN)
    return _as("a.glb")(folder, glb_of(text, binary))


def _blob(folder: Path, data: bytes) -> Path:
    """A blob whose size and checksums are right, whatever its table and sections say."""
    mended = bytearray(data)
    if len(mended) >= 24:
        count = min(struct.unpack_from("<I", mended, 12)[0], (len(mended) - 24) // 16)
        for entry in range(24, 24 + 16 * count, 16):
            start, length = struct.unpack_from("<II", mended, entry + 4)
            struct.pack_into("<I", mended, entry + 12, zlib.crc32(mended[start : start + length]))
        struct.pack_into("<II", mended, 16, len(mended), zlib.crc32(mended[24 : 24 + 16 * count]))
    return _as("a.blob")(folder, bytes(mended))


def _mem_with_manifest(folder: Path, data: bytes) -> Path:
    """Words, then a manifest whose checksum of them is right."""
    words, _, manifest = data.partition(_BETWEEN)
    try:
        document = json.loads(manifest)
        document["rom"]["crc32"] = f"{zlib.crc32(words):08x}"
        manifest = json.dumps(document).encode()
    except (ValueError, TypeError, KeyError, RecursionError):
        pass
    (folder / "a.json").write_bytes(manifest)
    return _as("a.mem")(folder, words)


def _read_scene(path: Path) -> None:
    """Load, and check what every scene promises."""
    assert_sound(voxelize.load(path))


def _read_rom(path: Path) -> None:
    """Read as told nothing, and as told a depth and a dialect."""
    refusals = []
    for options in ({}, {"depth": 3}, {"depth": 3, "dialect": "report"}, {"depth": 3, "dialect": "lod"}):
        try:
            blob, _ = export.read_any(path, **options)
        except REFUSALS as error:
            refusals.append(error)
            continue
        octree.census(blob.rom.octree)
        assert len(blob.rom.materials) <= 256
    if len(refusals) == 4:
        raise refusals[0]


def _mem_seeds() -> tuple[bytes, ...]:
    cube = np.zeros((8, 8, 8), int)
    cube[0, 0, 0], cube[5:, 2, 1] = 1, 2
    tree = octree.with_means(octree.Rom("a", octree.from_dense(cube), export.default_materials(2))).octree
    return tuple(
        "".join(f"{word:08x}\n" for word in octree.encode(tree.words, dialect, tree.means).tolist()).encode()
        for dialect in octree.DIALECTS
    )


def _manifest_seed() -> bytes:
    import tempfile

    cube = np.zeros((4, 4, 4), int)
    cube[1, 2, 3] = 1
    with tempfile.TemporaryDirectory() as folder:
        files = export.write_rom(Path(folder), octree.Rom("a", octree.from_dense(cube), export.default_materials(1)))
        return files.mem.read_bytes() + _BETWEEN + files.manifest.read_bytes()


def _blob_seed() -> bytes:
    cube = np.zeros((4, 4, 4), int)
    cube[1, 2, 3] = 1
    rom = octree.Rom("a", octree.from_dense(cube), export.default_materials(1), voxelize.Grid(2, (0.0, 0.0, 0.0), 1.0))
    view = Camera((-1, 2, 3), (0, 0, 90), (1, 0, 0), (0, 1, 0))
    return export.blob_bytes(export.Blob(rom, view, Lighting((5, -6, 7), 9, on=True, flat=False, bounces=3)))


def _vox_seed() -> bytes:
    def chunk(name: bytes, content: bytes = b"", children: bytes = b"") -> bytes:
        return name + struct.pack("<ii", len(content), len(children)) + content + children

    model = chunk(b"SIZE", struct.pack("<iii", 2, 3, 4)) + chunk(b"XYZI", b"\2\0\0\0\0\1\2\3\1\2\3\t")
    place = struct.pack("<i", 1) + b"\2\0\0\0_t" + struct.pack("<i", 5) + b"1 2 3" + b"\2\0\0\0_r\2\0\0\0" + b"17"
    nodes = [
        chunk(b"nTRN", struct.pack("<6i", 0, 0, 1, -1, 0, 1) + struct.pack("<i", 2) + place[4:]),
        chunk(b"nGRP", struct.pack("<4i", 1, 0, 1, 2)),
        chunk(b"nSHP", struct.pack("<5i", 2, 0, 1, 0, 0)),
        chunk(b"LAYR", struct.pack("<iii", 0, 0, -1)),
    ]
    body = model + b"".join(nodes) + chunk(b"RGBA", bytes(range(256)) * 4)
    return b"VOX " + struct.pack("<i", 150) + chunk(b"MAIN", b"", body)


def _las_seed() -> bytes:
    """LAS 1.2, point format 2, two points."""
    head = b"LASF" + bytes(20) + b"\1\2" + bytes(64) + struct.pack("<HHHIIBHI", 1, 1, 227, 227, 0, 2, 26, 2)
    head += bytes(20) + struct.pack("<12d", *[0.01] * 3, *[5e5, 5e6, 0], *[5e5 + 1, 5e5, 5e6 + 2, 5e6, 3, 0])
    points = (struct.pack("<3iH4B2B3H", *at, 0, 9, 1, 0, 0, 0, 0, 65535, 0, 257) for at in ((0, 0, 0), (100, 200, 300)))
    return head + b"".join(point.ljust(26, b"\0") for point in points)


_XYZ = b"# x y z r g b\n0 0 0 255 0 10\n1.5, -2, 3e2, 0, 128, 20\n4;5;6;7;8;9\n"
_OBJ = b"""mtllib a.mtl
o house
v 0 0 0 1 0 0
v 1 0 0
v 1 1 0 0.5 0.5 0.5
v 0 1 0
vt 0 0
vt 1 1
usemtl red
f 1/1 2/2 3/1 4/2
g roof
usemtl glass
f -4//1 -2 -1 \\
 # joined
f 1 2 3
"""
_MTL = b"""newmtl red
Kd 1 0 0.5
map_Kd -s 2 2 -o .5 0 -clamp on a.png
map_d a.png
newmtl glass
d 0.2
Tr 0.8
"""
_STL_TEXT = b"""solid one
facet normal 0 0 1
 outer loop
  vertex 0 0 0
  vertex 1 0 0
  vertex 0 1e0 0
 endloop
endfacet
endsolid one
"""
_STL = b"COLOR=\1\2\3\xff".ljust(80) + struct.pack(
    "<I12fH12fH", 2, *range(12), 0x801F, *[0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0], 1
)
_PLY_HEADER = """ply
format {} 1.0
comment a
element vertex 4
property float x
property float y
property double z
property uchar red
property uchar green
property uchar blue
element face 2
property list uchar int vertex_indices
element tristrips 1
property list int int vertex_indices
end_header
"""
_PLY_TEXT = _PLY_HEADER.format("ascii").encode() + (
    b"0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n1 1 0 9 9 9\n3 0 1 2\n4 0 1 3 2\n5 0 1 2 -1 3\n"
)
_PLY = _PLY_HEADER.format("binary_little_endian").encode() + b"".join(
    [
        *(struct.pack("<ffd3B", x, y, 0, x, y, 9) for x, y in ((0, 0), (1, 0), (0, 1), (1, 1))),
        struct.pack("<B3iB4i", 3, 0, 1, 2, 4, 0, 1, 3, 2),
        struct.pack("<6i", 5, 0, 1, 2, -1, 3),
    ]
)
_TOML = b"""background = "#102030"
[materials.grass]
colour = [1, 2, 3]
id = 7
mirror = true
[camera]
eye = [9, 9, 9]
target = [0, 0, 0]
field_of_view = 60
[light]
position = [1, 2, 3]
[[objects]]
name = "lawn"
box = { size = [1, 2, 3], corner = [0, 0, 0] }
material = "grass"
collider = "box"
[[objects]]
difference = [{ sphere = { radius = 2 } }, { cylinder = { radius = 1, height = 9, axis = "z" }, rotate = [0, 90, 0] }]
[[objects]]
group = [
    { extrude = { outline = [[0, 0], [1, 0], [0, 1]], height = 1 } },
    { hull = [{ cone = { radius = 1, height = 2 } }] },
]
scale = [1, -1, 2]
"""


def _seeds_of_rich() -> tuple[bytes, bytes]:
    made = rich()
    text = json.dumps(made.json).encode()
    return text + _BETWEEN + bytes(made.data), glb_of(text, made.data)


_OFF = b"OFF\n# four corners\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 1\n3 0 1 2\n3 1 3 2\n"
_3MF = b"""<model unit="inch" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
<resources><basematerials id="5"><base name="red" displaycolor="#FF0000"/></basematerials>
<object id="1" name="part" pid="5" pindex="0"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>
<vertex x="0" y="1" z="0"/></vertices><triangles><triangle v1="0" v2="1" v3="2" p1="0"/></triangles></mesh></object>
<object id="2"><components><component objectid="1" transform="1 0 0 0 1 0 0 0 1 5 0 0"/></components></object>
</resources><build><item objectid="2"/></build></model>"""
_DAE = b"""<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="cm" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p">
<float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry>
</library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><translate>1 2 3</translate>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>"""

_COE = b"memory_initialization_radix=16;memory_initialization_vector=" + b",".join(_mem_seeds()[0].split()) + b";"
_MIF = b"""DEPTH=9; WIDTH=32; ADDRESS_RADIX=HEX; DATA_RADIX=HEX;
CONTENT BEGIN
0:00000001;
[1..8]:FFFFFF01;
END;
"""
_RICH, _RICH_GLB = _seeds_of_rich()
_OBJ_WORDS = (*b"v vt vn f o g usemtl mtllib newmtl Kd map_Kd map_d d Tr -s -o -clamp on".split(), b"\\\n", b"1/2/3")
_PLY_WORDS = tuple(b"element property list uchar int float vertex face tristrips vertex_indices ascii 1.0 nan".split())

READERS = {
    "gltf": Reader(_glb, _read_scene, (_RICH,), tuple(b'"sparse" "count" 5126 "VEC3" null 1e39 -1'.split())),
    "glb": Reader(_as("a.glb"), _read_scene, (_RICH_GLB,), (b"glTF", b"JSON", b"BIN\0"), (".glb", ".gltf")),
    "obj": Reader(_pair("a.obj", "a.mtl"), _read_scene, (_OBJ + _BETWEEN + _MTL,), _OBJ_WORDS, (".obj",)),
    "stl": Reader(_as("a.stl"), _read_scene, (_STL_TEXT, _STL), (b"solid", b"facet", b"vertex", b"1e999"), (".stl",)),
    "ply": Reader(_as("a.ply"), _read_scene, (_PLY_TEXT, _PLY), _PLY_WORDS, (".ply",)),
    "off": Reader(_as("a.off"), _read_scene, (_OFF,), (b"COFF", b"#", b"1e999", b"-1")),
    "3mf": Reader(_zipped("a.3mf", "3D/3dmodel.model"), _read_scene, (_3MF,), (b"pid=", b"p1=", b"path=", b"<base")),
    "dae": Reader(_as("a.dae"), _read_scene, (_DAE,), (b"polylist", b"vcount", b"matrix", b"&x;", b"1e999")),
    "xyz": Reader(_as("a.xyz"), _read_scene, (_XYZ,), tuple(b"# // , ; nan 1e999 1_0 -".split())),
    "las": Reader(_as("a.las"), _read_scene, (_las_seed(),), (b"LASF", b"\0\0\0\0", b"\xff\xff\xff\xff", b"laszip")),
    "vox-scene": Reader(_as("a.vox"), _read_scene, (_vox_seed(),), (b"SIZE", b"XYZI", b"PACK", b"nTRN", b"nSHP")),
    "toml": Reader(
        _as("a.toml"),
        _read_scene,
        (_TOML, (EXAMPLES / "playground.toml").read_bytes()),
        tuple(b"[[objects]] union difference hull group asset box size = { } [ ] 1e9".split()),
        (".toml",),
    ),
    "mem": Reader(_as("a.mem"), _read_rom, _mem_seeds(), (b"ffffff01", b"00000009", b"@0", b"//"), (".mem",)),
    "manifest": Reader(_mem_with_manifest, _read_rom, (_manifest_seed(),), (b'"materials"', b"null", b"1e999")),
    "coe": Reader(_as("a.coe"), _read_rom, (_COE,)),
    "mif": Reader(_as("a.mif"), _read_rom, (_MIF,)),
    "blob": Reader(_blob, _read_rom, (_blob_seed(),), (b"NAME", b"WRLD", b"MATL", b"WORD", b"VIEW", b"LITE")),
    "vox": Reader(_as("a.vox"), _read_rom, (_vox_seed(),), (b"SIZE", b"XYZI", b"nTRN", b"nGRP", b"nSHP"), (".vox",)),
}
"""By name."""
