"""What people do with voxrt, each task by its command lines. README shows the same lines."""

from __future__ import annotations

from typing import NamedTuple


class Task(NamedTuple):
    """A task."""

    purpose: str
    lines: tuple[tuple[str, str], ...]  # command lines, each with what it does


# fmt: off
TASKS = {
    "scene": Task("Turn a scene of your own into an octree memory.", (
        ("voxrt-build model.glb -o out --preview", "out/model.mem, out/model.json, out/model.preview.png"),
        ("voxrt-build part.obj --up z --unit mm --depth 8", "z is up, millimetres, 256 voxels per side"),
        ("voxrt-build model.glb -o lit --bake --preview", "the soft light of a sun and a sky"),
        ("voxrt-build walk.glb --frames 0:2:24", "an animation"),
    )),
    "picture": Task("Make pictures of a memory.", (
        ("voxrt render out/model.mem -o close.png --position 20,40,160 --look 0,-1,-3", "from a place of your own"),
        ("voxrt render out/model.mem -o model.png --check", "by the simulated hardware, too"),
        ("voxrt render out/model.mem --turntable", "from all sides"),
    )),
    "ray": Task("Look into an octree, and follow a ray through it.", (
        ("voxrt trace out/model.mem --pixel 320,240", "prints each word that one ray reads"),
        ("voxrt view out/model.mem", "shows the octants in a window"),
    )),
    "browser": Task("Show scenes live in a browser.", (
        ("voxrt serve model.glb", "the scene, to turn and to fly through"),
    )),
    "board": Task("Show a scene on an FPGA board, or take the core into a design of your own.", (
        ("voxrt bitstream model.glb --board ulx3s-85f --load", "a monitor shows the scene, turning"),
        ("voxrt upload out/model.mem --to serial:/dev/ttyUSB0", "another scene"),
        ("voxrt core --config octo --verilog octo.v", "the core as one file of Verilog"),
    )),
}
"""By name, in the order of README."""
