"""The core in plain Verilog, simulated by Icarus Verilog, shows what the exact model does."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
from oracles.icarus import needs_icarus
from oracles.memory import words_of
from oracles.random_cameras import random_voxels

from voxrt.board.registers import MATERIALS, REGISTERS
from voxrt.boards.plain_verilog import merge_modules, plain_verilog
from voxrt.rtl.configurations import list_sources, read_configurations
from voxrt.sim import _model

BENCH = Path(__file__).parent / "verilog" / "tb.v"
SIZE = (16, 12)
DEPTH = 3
WRITE_MEMORY, WRITE_REGISTER, READ_REGISTER, WAIT_REGISTER, CHECK_MEMORY = range(5)


def register(name: str) -> int:
    return REGISTERS[name][0]


def bits(name: str, **fields: int) -> int:
    return sum(value << REGISTERS[name][1][field][0] for field, value in fields.items())


def scene_commands(words, table, camera, *, shading, faces, light):
    """What loads a scene, starts a frame, waits for its end and reads what it cost."""
    width, height = SIZE
    commands = [(WRITE_REGISTER, register("control"), bits("control", hold=1))]
    commands += [(WRITE_MEMORY, 4 * place, word) for place, word in enumerate(words)]
    commands += [(CHECK_MEMORY, 4 * place, words[place]) for place in (0, 1, len(words) - 1)]
    commands += [(WRITE_REGISTER, MATERIALS + 4 * material, row) for material, row in enumerate(table)]
    triples = {**dict(zip(("position", "look", "right", "up"), camera.tolist(), strict=True)), "light": light}
    values = {
        "size": bits("size", width=width, height=height),
        "depth": DEPTH,
        **{f"{name}[{axis}]": triple[axis] for name, triple in triples.items() for axis in range(3)},
        "shading": shading,
        "lower_faces": bits("lower_faces", **dict(zip("xyz", faces[::2], strict=True))),
        "upper_faces": bits("upper_faces", **dict(zip("xyz", faces[1::2], strict=True))),
        "control": bits("control", start=1),
    }
    commands += [(WRITE_REGISTER, register(name), value & 0xFFFFFFFF) for name, value in values.items()]
    commands.append((WAIT_REGISTER, register("status"), bits("status", frame_done=1)))
    commands += [(READ_REGISTER, register(name), 0) for name in ("identity", "configuration", "status", "rays")]
    return commands


def simulate(verilog, commands, folder, *, memory_clocks):
    """Run the bench; give the transfers of the stream and the registers read."""
    (folder / "core.v").write_text(verilog)
    lines = [f"{operation:x}{address:08x}{int(data):08x}" for operation, address, data in commands]
    (folder / "commands.hex").write_text("\n".join(lines) + "\n")
    settings = [f"-Ptb.COMMANDS={len(commands)}", f"-Ptb.MEMORY_CLOCKS={memory_clocks}"]
    build = ["iverilog", "-g2001", "-Wall", "-Wno-timescale", "-s", "tb", *settings, "-o", "tb.vvp", "core.v", BENCH]
    built = subprocess.run(build, cwd=folder, capture_output=True, text=True, check=False)
    assert (built.returncode, built.stdout + built.stderr) == (0, "")
    ran = subprocess.run(["vvp", "-n", "tb.vvp"], cwd=folder, capture_output=True, text=True, check=True)
    assert ran.stdout.startswith("done in "), ran.stdout
    transfers = [line.split() for line in (folder / "stream.txt").read_text().splitlines()]
    reads = [line.split() for line in (folder / "reads.txt").read_text().splitlines()]
    return transfers, {int(address, 16): int(data, 16) for address, data in reads}


def picture(transfers):
    """Join the bytes of a stream to a picture, red, green, blue, and check where frame and lines begin and end."""
    width, height = SIZE
    beats = [(user, last) for user, last, _, _ in transfers]
    a_line = -(-3 * width // 4)
    assert beats == [
        (str(int(number == 0)), str(int(number % a_line == a_line - 1))) for number in range(a_line * height)
    ]
    taken = bytearray()
    for _, _, keep, data in transfers:
        taken += bytes(byte for place, byte in enumerate(bytes.fromhex(data)[::-1]) if int(keep, 16) >> place & 1)
    return np.frombuffer(taken, np.uint8).reshape(height, width, 3)[..., [2, 0, 1]]


@needs_icarus
@pytest.mark.parametrize("name", ["tiny", "lit"])
def test_icarus_shows_what_the_model_does(name, plain, tmp_path):
    rng = np.random.default_rng(5)
    configuration = read_configurations()[name]
    colours = rng.integers(0, 256, (256, 3), dtype=np.uint8)
    mirrors = np.zeros(256, np.uint8)
    voxels = random_voxels(rng, DEPTH, 0.2)
    words = np.array(words_of(voxels), np.uint32)
    camera = np.array([[-45, 150, -60], [500, -280, 560], [24, 0, -22], [8, 32, 9]], np.int32)
    faces = (189, 40, 140, 255, 219, 200)
    settings, shading, light = {"brightness": np.array(faces, np.uint8)}, bits("shading", faces=1), (0, 0, 0)
    if configuration.features:
        mirrors[voxels[voxels > 0][::3]] = 1
        light = (40, 200, -30)
        settings |= {"light": np.array(light, np.int32), "ambient": 40, "bounces": 2, "mirrors": mirrors}
        shading = bits("shading", faces=1, light=1, ambient=40, bounces=2)
    model = _model.Memory(words, DEPTH).render(colours, camera, *SIZE, **settings)
    assert len(np.unique(model.material)) > 3
    table = [
        int(mirror) << 24 | red << 16 | green << 8 | blue
        for mirror, (red, green, blue) in zip(mirrors, colours.tolist(), strict=True)
    ]
    transfers, reads = simulate(
        plain(name),
        scene_commands(words, table, camera, shading=shading, faces=faces, light=light),
        tmp_path,
        memory_clocks=3,
    )
    np.testing.assert_array_equal(picture(transfers), model.colour)
    assert reads[register("identity")] == int.from_bytes(b"VXRT", "big")
    assert reads[register("status")] == bits("status", frame_done=1)
    assert reads[register("rays")] >= SIZE[0] * SIZE[1]


TWO_QUEUES = """
module voxrt_core(clk_i, a_o
, b_o);
  input clk_i;
  wire clk_i;
  output [3:0] a_o;
  wire [3:0] a_o;
  output b_o;
  reg b_o;
  \\voxrt_queue$voxrt_core.gen[0].u_queue  gen_0_u_queue ( .data_o(a_o[1:0]) );
  \\voxrt_queue$voxrt_core.gen[1].u_queue  gen_1_u_queue ( .data_o(a_o[3:2]) );
  \\voxrt_queue$voxrt_core.u_wide  u_wide ( .data_o(b_o__and_A__or_Y) );
endmodule

module \\voxrt_queue$voxrt_core.gen[0].u_queue (data_o);
  output [1:0] data_o;
  wire [1:0] data_o;
endmodule

module \\voxrt_queue$voxrt_core.gen[1].u_queue (data_o);
  output [1:0] data_o;
  wire [1:0] data_o;
endmodule

module \\voxrt_queue$voxrt_core.u_wide (data_o);
  output [8:0] data_o;
  reg [8:0] \\gen_wide.rows_q  [3:0];
endmodule
"""

MERGED = """
module voxrt_core (
  clk_i, a_o, b_o
);
  input clk_i;
  output [3:0] a_o;
  output b_o;
  reg b_o;
  voxrt_queue_2 gen_0_u_queue ( .data_o(a_o[1:0]) );
  voxrt_queue_2 gen_1_u_queue ( .data_o(a_o[3:2]) );
  voxrt_queue_1 u_wide ( .data_o(_net1) );
endmodule

module voxrt_queue_1 (
  data_o
);
  output [8:0] data_o;
  reg [8:0] gen_wide_rows_q [3:0];
endmodule

module voxrt_queue_2 (
  data_o
);
  output [1:0] data_o;
endmodule
"""


def test_modules_that_are_alike_become_one():
    assert merge_modules(TWO_QUEUES) == MERGED


def test_the_text_is_the_same_each_time_and_speaks_of_no_machine(plain):
    text = plain("tiny")
    assert text == plain_verilog(read_configurations()["tiny"])
    assert str(Path.home()) not in text
    assert "/tmp" not in text
    assert re.findall(r"^// The ray tracer of voxrt .*", text, re.MULTILINE)


def test_lanes_are_instances_of_one_module(plain):
    text = plain("quad")
    modules = re.findall(r"^module (\w+)", text, re.MULTILINE)
    assert len(modules) == len(set(modules))
    assert {"voxrt_core", "voxrt_lane", "voxrt_buffered_lane"} <= set(modules)
    assert len(re.findall(r"^  voxrt_buffered_lane \w+ \(", text, re.MULTILINE)) == 4
    assert len(text) < 2 * len(plain("tiny"))


def test_memories_stay_memories(plain):
    """The octree memory, and what the sources ask block RAM for."""
    text = plain("quad")
    assert re.search(r"^  reg \[12:0\] data_q \[32767:0\];", text, re.MULTILINE)
    sources = "".join(path.read_text() for path in list_sources())
    assert set(re.findall(r"\(\* ram_style = .*? \*\)", text)) == set(re.findall(r"\(\* ram_style = .*? \*\)", sources))
