"""Verify that a board traces its pictures in time: ``python bench/beam.py NAME [--frames 60] [--write]``.

The sources of the board's design are simulated from power-on, with the octree and the boot table that ``voxrt
bitstream`` makes of each scene. A monitor at the DVI pins measures each frame. Each picture is compared with the exact
model's, and the board's counters of late rows and late frames are read by the serial line. ``--write`` writes
``bench/results/beam-NAME.md``. Needs a C++ compiler; a frame takes seconds.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from report import ROOT, options_of, publish, table
from rtl_scenes import terrain

import voxrt
from voxrt.board.designs import build
from voxrt.board.designs.boot_table import boot_table, encode_octree
from voxrt.board.designs.simulation.board_simulation import BoardSimulation, compile_sources
from voxrt.boards.beam import SCREEN, BeamFit, fit_beam
from voxrt.boards.bitstream import BaseDesign, read_board
from voxrt.boards.board_scenes import board_scene
from voxrt.export import Blob
from voxrt.octree import Rom, from_dense
from voxrt.views.viewpoint import orbit

sys.path.append(str(ROOT / "tests"))
from fakes.board_host import Host

if TYPE_CHECKING:
    from voxrt.octree.camera import Camera

EXAMPLES = ("house.obj", "planet.glb", "courtyard.glb")
PERIOD = 3
"""Frames per camera of the boot table."""
MATERIALS = (
    voxrt.Material("empty", (0, 0, 0)),
    voxrt.Material("grass", (96, 160, 72)),
    voxrt.Material("earth", (150, 120, 84)),
)


class Seen(NamedTuple):
    """What a monitor and a host saw of a scene."""

    beam: BeamFit
    words: int
    frames: int
    exact: int
    vga: int
    underruns: int
    late: int

    @property
    def holds(self) -> bool:
        """Every frame is exact and in time."""
        return self.exact == self.vga == self.frames and self.underruns == self.late == 0


def rom_of(name: str, capacity: int) -> Rom:
    """Build an example for a memory of so many words, or make the terrain."""
    if name != "terrain":
        return voxrt.build(ROOT / "examples" / name, budget=capacity).rom
    return Rom("terrain", from_dense(terrain(6)), MATERIALS)


def watch(rom: Rom, design: BaseDesign, program: Path, folder: Path, frames: int) -> Seen:
    lighting = voxrt.Lighting()
    beam = fit_beam(rom, orbit(rom, SCREEN), lighting, design.tracer)
    cameras = orbit(rom, beam.size)
    scene = board_scene(Blob(rom))
    contents = {
        "octree": encode_octree(scene.words, design.core["BlockBits"]),
        "table": boot_table(scene, cameras, lighting, scale=beam.scale, period=PERIOD),
    }
    with BoardSimulation(program, folder, contents) as simulation:
        simulation.frames(1)  # until the first vertical blanking the screen is black
        exact = vga = 0
        for number in range(frames):
            pixels, timing = simulation.frames(1)[0]
            vga += timing.is_vga
            exact += np.array_equal(pixels, picture(rom, cameras[number // PERIOD], beam))
        host = Host(simulation)
        underruns, late = host.register("underruns"), host.register("late")
    return Seen(beam, len(rom.octree.words), frames, exact, vga, underruns, late)


def picture(rom: Rom, camera: Camera, beam: BeamFit) -> np.ndarray:
    """Give what the screen must show: each pixel of the exact model as a square."""
    frame = voxrt.render(rom, camera, size=beam.size, engine="model").colour
    return frame.repeat(1 << beam.scale, 0).repeat(1 << beam.scale, 1)


def report(name: str, design: BaseDesign, found: dict[str, Seen]) -> str:
    lanes = f"{design.core['Lanes']} lane{'' if design.core['Lanes'] == 1 else 's'}"
    heads = ("scene", "words", "picture", "cycles per pixel", "lines ahead")
    heads += ("frames", "exact", "timing of 640 x 480", "rows repeated", "frames late")
    about = (
        f"# {name}: pictures in time\n\n"
        f"`python bench/beam.py {name} --write`: sources of the board's design, simulated;\n"
        f"{lanes} at {design.clock_hz / 1e6:.1f} MHz, pixel clock 25 MHz.\n\n"
    )
    rows = []
    for scene, seen in found.items():
        beam, size = seen.beam, f"{seen.beam.size[0]} x {seen.beam.size[1]}"
        row = [scene, f"{seen.words:,}", size, f"{beam.cycles_per_pixel:.2f}", f"{beam.lead:.1f}"]
        row += [str(count) for count in (seen.frames, seen.exact, seen.vga, seen.underruns, seen.late)]
        rows.append(row)
    return about + table(heads, rows, left=1)


def main() -> int:
    """Watch each scene; give the exit code."""
    parser = options_of(__doc__)
    parser.add_argument("name", choices=build.board_names())
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--scenes", nargs="*", default=[*EXAMPLES, "terrain"])
    options = parser.parse_args()
    design = read_board(options.name).design
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        program = compile_sources(build.read_board(options.name), Path(folder, "program"))
        for scene in options.scenes:
            rom = rom_of(scene, design.capacity)
            found[scene] = watch(rom, design, program, Path(folder), options.frames)
            print(scene, found[scene], file=sys.stderr)
    publish(f"beam-{options.name}.md", report(options.name, design, found), write=options.write)
    return 0 if all(seen.holds for seen in found.values()) else 1


if __name__ == "__main__":
    sys.exit(main())
