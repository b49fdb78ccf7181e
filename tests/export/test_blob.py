import random
import shutil
import struct
import subprocess
import zlib
from pathlib import Path

import numpy as np
import pytest
from fakes.blob import rewritten
from hypothesis import given, settings
from msgspec.structs import replace
from oracles.kaitai import Description
from oracles.random_worlds import dense_cubes

from voxrt import export, octree
from voxrt.octree import Rom, RomError
from voxrt.octree.camera import Camera, Lighting
from voxrt.voxelize import EMPTY, Grid, Material

DOCS = Path(__file__).parents[2] / "docs"
MATERIALS = (
    EMPTY,
    Material("red", (255, 0, 1)),
    Material("mirror \N{SNOWMAN}", (1, 2, 3), mirror=True, authored=False),
)
VIEW = Camera((-1, 2, 3), (0, 0, 90), (1, 0, 0), (0, -32768, 0))
LIGHTING = Lighting((5, -6, 7), ambient=9, on=True, flat=False, bounces=3)


def blob(view=VIEW, lighting=LIGHTING, grid=Grid(2, (1.5, -2.0, 0.1), 0.25)):  # noqa: B008 - frozen
    cube = np.zeros((4, 4, 4), int)
    cube[0, 0, 0], cube[3, 2, 1] = 1, 2
    return export.Blob(Rom("scene \N{SNOWMAN}", octree.from_dense(cube), MATERIALS, grid), view, lighting)


@pytest.mark.parametrize(
    "change",
    [
        {},
        {"view": None},
        {"lighting": None},
        {"grid": None},
        {"lighting": Lighting(faces=(1, 2, 3, 4, 5, 255))},
        {"lighting": Lighting(faces=None, flat=True)},
    ],
)
def test_round_trip(tmp_path, change):
    written = blob(**change)
    export.write_blob(tmp_path / "a.blob", written)
    read = export.read_blob(tmp_path / "a.blob")
    assert (read.view, read.lighting) == (written.view, written.lighting)
    assert (read.rom.name, read.rom.materials, read.rom.grid) == (written.rom.name, MATERIALS, written.rom.grid)
    np.testing.assert_array_equal(read.rom.octree.words, written.rom.octree.words)
    assert export.blob_bytes(read) == (tmp_path / "a.blob").read_bytes()


@given(cube=dense_cubes(3))
@settings(max_examples=30)
def test_any_world_survives(tmp_path_factory, cube):
    path = tmp_path_factory.mktemp("blob") / "a.blob"
    export.write_blob(path, export.Blob(Rom("a", octree.from_dense(cube), export.default_materials(255))))
    np.testing.assert_array_equal(octree.to_dense(export.read_blob(path).rom.octree), cube)


def test_the_kaitai_description_reads_what_is_written():
    written = blob(lighting=replace(LIGHTING, faces=(1, 2, 3, 4, 5, 255)))
    data = export.blob_bytes(written)
    read = Description((DOCS / "voxrt_blob.ksy").read_text()).read(data)
    assert (read["version"], read["len_file"]) == (1, len(data))
    assert read["table_crc32"] == zlib.crc32(data[24 : 24 + 16 * read["num_sections"]])
    sections = {section["name"]: section for section in read["sections"]}
    assert list(sections) == ["NAME", "WRLD", "MATL", "WORD", "VIEW", "LITE", "FACE"]
    for section in sections.values():
        body = data[section["ofs_body"] : section["ofs_body"] + section["len_body"]]
        assert section["crc32"] == zlib.crc32(body)
        assert section["ofs_body"] % 8 == 0
    body = {name: section["body"] for name, section in sections.items()}
    assert body["NAME"] == {"text": written.rom.name}
    assert body["WRLD"] == {"depth": 2, "known": 1, "origin": [1.5, -2.0, 0.1], "voxel_size": 0.25}
    assert [(m["name"], (m["red"], m["green"], m["blue"]), m["flags"]) for m in body["MATL"]["entries"]] == [
        ("empty", EMPTY.colour, 2),
        ("red", (255, 0, 1), 2),
        (MATERIALS[2].name, (1, 2, 3), 1),
    ]
    assert body["WORD"]["words"] == written.rom.octree.words.tolist()
    assert body["VIEW"] == {"position": [-1, 2, 3], "look": [0, 0, 90], "right": [1, 0, 0], "up": [0, -32768, 0]}
    assert body["LITE"] == {"position": [5, -6, 7], "ambient": 9, "flags": 1, "bounces": 3, "zero": 0}
    assert body["FACE"] == {"brightness": [1, 2, 3, 4, 5, 255]}


PROGRAM = r"""
#include <stdio.h>
#include "voxrt_blob.h"
static uint64_t data[4096];
int main(int argc, char **argv) {
    FILE *file = fopen(argv[argc - 1], "rb");
    const size_t size = fread(data, 1, sizeof data, file);
    const struct voxrt_header *blob = (const void *)data;
    if (memcmp(blob->magic, VOXRT_MAGIC, 8) || blob->version != VOXRT_VERSION || blob->bytes != size) return 1;
#define SECTION(name) (const void *)((const char *)data + voxrt_find(blob, name)->offset)
    const struct voxrt_world *world = SECTION("WRLD");
    printf("%u %u %g %g %g %g\n", world->depth, world->known, world->origin[0], world->origin[1], world->origin[2],
           world->voxel_size);
    const uint32_t *count = SECTION("MATL");
    const struct voxrt_material *material = (const void *)(count + 1);
    for (uint32_t i = 0; i < *count; ++i, material = voxrt_next_material(material))
        printf("%d %d %d %u %.*s\n", material->red, material->green, material->blue, material->flags,
               material->name_bytes, (const char *)(material + 1));
    const uint32_t *word = SECTION("WORD");
    for (uint32_t i = 0; i < voxrt_find(blob, "WORD")->bytes / 4; ++i) printf("%08X ", word[i]);
    const struct voxrt_view *view = SECTION("VIEW");
    const struct voxrt_lighting *light = SECTION("LITE");
    printf("\n%d %d %d %d\n", view->position[0], view->look[2], view->right[0], view->up[1]);
    printf("%d %u %u %u\n", light->position[1], light->ambient, light->flags, light->bounces);
    return voxrt_find(blob, "NONE") != NULL;
}
"""


def test_the_c_header_reads_what_is_written(tmp_path):
    compiler = shutil.which("cc") or shutil.which("gcc")
    if compiler is None:
        pytest.skip("no C compiler (cc or gcc) on PATH")
    written = blob()
    export.write_blob(tmp_path / "a.blob", written)
    (tmp_path / "read.c").write_text(PROGRAM)
    command = [compiler, "-std=c99", "-Wall", "-Wextra", "-Werror", f"-I{DOCS}", "read.c", "-o", "read"]
    subprocess.run(command, cwd=tmp_path, check=True)
    result = subprocess.run([tmp_path / "read", "a.blob"], cwd=tmp_path, check=True, capture_output=True, text=True)
    assert result.stdout.splitlines() == [
        "2 1 1.5 -2 0.1 0.25",
        "{} {} {} 2 empty".format(*EMPTY.colour),
        "255 0 1 2 red",
        f"1 2 3 1 {MATERIALS[2].name}",
        "".join(f"{word:08X} " for word in written.rom.octree.words),
        "-1 90 1 -32768",
        "-6 9 1 3",
    ]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda _: b"", "does not start with VOXRTBLB; name a blob"),
        (lambda d: d[:20], "header: is cut short"),
        (lambda d: d[:8] + b"\2" + d[9:], "blob version 2 is not known to this version"),
        (lambda d: d[:-8], "header: speaks of"),
        (lambda d: d + b"\0", "header: speaks of"),
        (lambda d: d[:12] + b"\xff\xff\xff\xff" + d[16:], "header: speaks of"),
        (lambda d: d[:30] + b"\xff" + d[31:], "header: speaks of"),
        (lambda d: d.replace(b"red", b"rad"), r"section MATL: is damaged \(CRC-32\)"),
        (lambda d: rewritten(d, b"MATL"), "section MATL: is missing"),
        (lambda d: rewritten(d, b"NAME", b"\xff"), "has another layout than that of version 1"),
        (lambda d: rewritten(d, b"NAME", b"n" * 1001), "section NAME: 1001 characters are no name; it may have 1000"),
        (lambda d: rewritten(d, b"VIEW", b"1234"), "has another layout"),
        (lambda d: rewritten(d, b"WORD", b"12345"), "section WORD: 5 bytes are not words of 4"),
        (lambda d: rewritten(d, b"WORD", b"\2\0\0\0"), "word 0x0: pointer 00000002 does not stand"),
        (lambda d: rewritten(d, b"WRLD", struct.pack("<II4d", 99, 0, 0, 0, 0, 0)), "depth 99 is outside"),
        (lambda d: rewritten(d, b"WRLD", struct.pack("<II4d", 2, 1, 0, 0, 0, float("nan"))), "the grid stands nowhere"),
        (lambda d: rewritten(d, b"MATL", b"\0\0\0\0"), r"0 materials are not 1 \.\.\. 256"),
        (lambda d: rewritten(d, b"MATL", b"\3\0\0\0"), "section MATL: is cut short"),
        (lambda d: rewritten(d, b"MATL", b"\1\0\0\0" + bytes(8)), "ends at material 0 and 2 is in use"),
    ],
)
def test_damaged_blobs_are_refused(tmp_path, change, message):
    path = tmp_path / "a.blob"
    path.write_bytes(change(export.blob_bytes(blob())))
    with pytest.raises(RomError, match=message):
        export.read_blob(path)


def test_the_longest_name_is_read(tmp_path):
    path = tmp_path / "a.blob"
    path.write_bytes(rewritten(export.blob_bytes(blob()), b"NAME", "é".encode() * 1000))
    assert export.read_blob(path).rom.name == "é" * 1000


def test_names_too_long_for_their_field_end_at_a_character(tmp_path):
    whole = blob()
    rom = replace(whole.rom, materials=(EMPTY, *(Material("é" * 40_000 + str(i), (i, 0, 0)) for i in (1, 2))))
    path = tmp_path / "a.blob"
    path.write_bytes(export.blob_bytes(replace(whole, rom=rom)))
    assert export.read_blob(path).rom.materials[1].name == "é" * 32_767


def test_unknown_sections_are_passed_over(tmp_path):
    path = tmp_path / "a.blob"
    path.write_bytes(rewritten(export.blob_bytes(blob()), b"MORE", b"later versions"))
    assert export.read_blob(path).view == VIEW


def test_any_damaged_byte_is_noticed(tmp_path):
    data = bytearray(export.blob_bytes(blob()))
    path = tmp_path / "a.blob"
    rng = random.Random(3)
    unnoticed = 0
    for i in range(len(data)):
        change = rng.randrange(1, 256)
        data[i] ^= change
        path.write_bytes(data)
        data[i] ^= change
        try:
            export.read_blob(path)
        except RomError:
            continue
        unnoticed += 1
    assert unnoticed < 40  # padding between sections
