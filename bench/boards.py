"""Verify the placed design of a board: ``python bench/boards.py NAME [--folder DIR] [--rebuilt] [--write]``.

Needs the folder in which ``python -m voxrt.board.designs.build NAME --netlist`` worked, and a C++ compiler. The
netlist after place and route is simulated with what was patched into its ``.config`` or ``.fs``: a monitor decodes the
DVI pins, and the frames are compared with the exact model's, on three scenes, and after a swap and edits by the serial
line. With ``--rebuilt``, one scene is built into the design from its sources as well, which takes another place and
route: both ``.config`` must be equal. ``--write`` writes ``report.md`` beside the board's description.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple
from unittest.mock import patch

import numpy as np
from msgspec.structs import replace

from voxrt.board.designs import build, serial_device
from voxrt.board.designs.base_design import Slice, patch_config
from voxrt.board.designs.boot_table import (
    BOARD_REGISTERS,
    CAMERAS,
    OCTREE_MEMORY,
    RUN,
    STEERED,
    TABLE,
    TURN,
    boot_table,
    encode_list,
    encode_octree,
    scene_writes,
)
from voxrt.board.designs.gowin_bitstream import BlockRams, patch_fs
from voxrt.board.designs.serial_device import SerialDevice
from voxrt.board.designs.serial_link import SerialLink
from voxrt.board.designs.simulation import placed_gowin, placed_netlist
from voxrt.board.designs.simulation.board_simulation import BoardSimulation, compile_placed
from voxrt.board.register_writes import camera_writes
from voxrt.board.scene_memory import SceneMemory
from voxrt.board.simulated.model import ModelDevice
from voxrt.board.view import Lighting
from voxrt.boards.board_scenes import load_scene
from voxrt.octree import Sphere
from voxrt.octree.words import move_pointers

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests"))
from fakes.board_host import Host, cameras_around, expected_crc, picture
from fakes.simulated_port import SimulatedPort

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.board.scene import Scene
    from voxrt.octree.camera import Camera

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
SCENES = {"house.obj": 5, "planet.glb": 5, "courtyard.glb": 6}
SCALE = 2  # 65 cycles per pixel at 75 MHz: no line comes too late, whatever the lanes.
SIZE = (640 >> SCALE, 480 >> SCALE)
FREE_LIST = 1024  # words of the table that the boot list does not use


def orbit(scene: Scene) -> list[Camera]:
    return cameras_around(scene, SIZE, radius=1.3, height=0.7, steps=CAMERAS)


def contents_of(scene: Scene, board: dict[str, Any]) -> dict[str, NDArray[np.uint32]]:
    return {
        "octree": encode_octree(scene.words, board.get("boot_block_bits", board["core"]["BlockBits"])),
        "table": boot_table(scene, orbit(scene), Lighting(), scale=SCALE, control=RUN | TURN, period=1),
    }


class Placed(NamedTuple):
    """A placed design: its board, its ``.config``, where memories are in that, and the program that simulates it.

    A design for a Gowin GW2A has its ``.fs`` instead, and block RAMs in that.
    """

    board: dict[str, Any]
    config: str
    slices: dict[str, list[Slice]]
    program: Path
    rams: BlockRams | None

    def write_contents(self, contents: dict[str, NDArray[np.uint32]], folder: Path) -> None:
        """Write what block RAMs hold, with these contents of memories, as the simulation reads it."""
        if self.rams is None:
            placed_netlist.write_block_rams(patch_config(self.config, self.slices, contents), folder)
        else:
            fs = patch_fs(self.config, self.rams, self.slices, contents)
            placed_gowin.write_block_rams(fs, self.rams, folder)

    @property
    def black(self) -> int:
        """Frames before the first picture: a frame buffer shows a picture when the next one starts."""
        return 2 if "boot_block_bits" in self.board else 1


def verify(name: str, folder: Path, work: Path, *, rebuilt: bool) -> list[tuple[str, bool]]:
    """Check the placed design in a folder; give what was checked, and whether it holds."""
    board = build.read_board(name)
    described = build.describe(board, name, board["seed"], folder)
    slices = {m: [Slice(**piece) for piece in d["slices"]] for m, d in described["memories"].items()}
    config = (folder / f"top.{build.config_kind(board)}").read_text()
    cells = placed_gowin if build.is_gowin(board) else placed_netlist
    (work / "placed.v").write_text(cells.placed_verilog(json.loads((folder / "placed.json").read_text())))
    program = compile_placed(board, [*cells.MODELS, work / "placed.v"], work / "placed")
    rams = BlockRams(**described["block_rams"]) if build.is_gowin(board) else None
    placed = Placed(board, config, slices, program, rams)
    scenes = {file: load_scene(EXAMPLES / file, depth) for file, depth in SCENES.items()}
    swapped = next(iter(scenes))

    def checks_of(file: str) -> list[tuple[str, bool]]:
        place = work / Path(file).stem
        place.mkdir()
        new = scenes["planet.glb"] if file == swapped else None
        return verify_scene(placed, file, scenes[file], new, place)

    # A simulation is a process of its own: scenes run side by side.
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = [check for checks in pool.map(checks_of, scenes) for check in checks]
    if rebuilt:
        contents = contents_of(scenes["house.obj"], board)
        build.synthesize(board, contents, work)
        build.place_and_route(board, described["seed"], work)
        kind = build.config_kind(board)
        patched = patch_config(config, slices, contents) if rams is None else patch_fs(config, rams, slices, contents)
        same = (work / f"top.{kind}").read_text() == patched
        found.append((f"the patched .{kind} is the one of a full rebuild with the scene, byte for byte", same))
    return found


def verify_scene(placed: Placed, file: str, scene: Scene, new: Scene | None, work: Path) -> list[tuple[str, bool]]:
    """Check the frames of a scene in the simulated netlist, and those of the scene that replaces it."""
    found: list[tuple[str, bool]] = []

    def note(what: str, *, holds: bool) -> None:
        print(f"{file}: {what}: {'holds' if holds else 'FAILS'}", file=sys.stderr)
        found.append((f"{file}: {what}", holds))

    placed.write_contents(contents_of(scene, placed.board), work)
    cameras = orbit(scene)
    with BoardSimulation(placed.program, work) as simulation:
        seen = simulation.frames(placed.black + 2)[placed.black :]
        equal = all(np.array_equal(pixels, picture(scene, cameras[i], SCALE)) for i, (pixels, _) in enumerate(seen))
        note("two frames at the pins are the exact model's, byte for byte", holds=equal)
        note("timing at the pins is that of 640 x 480", holds=all(timing.is_vga for _, timing in seen))
        if new is not None:
            base = -(-len(scene.words) // 8) * 8
            control = (BOARD_REGISTERS["control"], [1 << 8 | SCALE << 4 | STEERED | RUN])
            swap = [*scene_writes(new, Lighting(), SIZE, base), *camera_writes(orbit(new)[9]), control]
            host = Host(simulation)
            host.write(OCTREE_MEMORY + 4 * base, move_pointers(new.words, base))
            host.write(TABLE + 4 * FREE_LIST, encode_list(swap))
            host.write(BOARD_REGISTERS["play"], [FREE_LIST])
            after = simulation.frames(placed.black + 2)[-1][0]
            equal = np.array_equal(after, picture(new, orbit(new)[9], SCALE))
            note("planet.glb, sent by the serial line, is the exact model's picture", holds=equal)
            equal = host.frame_crc() == expected_crc(after, SCALE)
            note("the CRC of this frame, read by the serial line, is the exact model's", holds=equal)
            equal = edits_are_shown(simulation, new, orbit(new)[9], placed.black)
            note("edits of it by the serial line are the exact model's pictures", holds=equal)
    return found


def edits_are_shown(simulation: BoardSimulation, scene: Scene, camera: Camera, black: int) -> bool:
    """Edit the scene that a board shows, as voxrt serve does; tell whether the monitor shows each edit."""
    before, equal = picture(scene, camera, SCALE), True
    with patch.object(serial_device, "_WAIT_SECONDS", math.inf):  # a simulated frame takes many
        device = SerialDevice(SerialLink("the simulation", SimulatedPort(simulation)), ModelDevice())
        memory = SceneMemory(device, device.loaded())
        world = memory.world_of(scene)
        memory.begin_edits(world, scene)
        side, middle = world.size, world.size // 2
        edits = (
            lambda: world.set([[1, height, side - 2] for height in range(side)], 1),
            lambda: world.fill(Sphere((middle, side, middle), middle), 0),
            world.undo,
        )
        for edit in edits:
            edit()
            memory.show_edits(scene)
            after = picture(replace(scene, words=world.rom().octree.words), camera, SCALE)
            shown = simulation.frames(black + 1)[-1][0]
            equal = equal and np.array_equal(shown, after) and not np.array_equal(after, before)
            before = after
    return equal


def report(described: dict[str, Any], title: str, checks: list[tuple[str, bool]], seconds: float) -> str:
    core = ", ".join(f"{name} {value}" for name, value in described["core"].items())
    lines = [
        f"# {title}",
        "",
        "Made by `python bench/boards.py`. No board was at hand: this is what simulation and the tools say.",
        "",
        f"Core: {core}. Seed {described['seed']}. "
        + ", ".join(f"{tool} {number}" for tool, number in described["tools"].items())
        + ".",
        "",
        "| clock | needed, MHz | allowed by the longest path, MHz |",
        "|---|---|---|",
    ]
    pixel = described.get("pixel_hz", 25_000_000) / 1e6
    needed = {"system": described["clock_hz"] / 1e6, "pixel": pixel, "bit": 5 * pixel}
    lines += [f"| {clock} | {needed[clock]:g} | {mhz:g} |" for clock, mhz in described["fmax_mhz"].items()]
    lines += ["", "| cells | used | of |", "|---|---|---|"]
    lines += [f"| {cell} | {used:,} | {of:,} |" for cell, (used, of) in described["utilisation"].items()]
    lines += ["", f"Netlist after place and route, simulated ({seconds:.0f} s):", ""]
    lines += [f"- {what}: {'holds' if holds else '**fails**'}" for what, holds in checks]
    return "\n".join(lines) + "\n"


def main() -> int:
    """Verify, and print or write the report; give the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("name", choices=build.board_names())
    parser.add_argument("--folder", type=Path, default=Path("build", "board"), help="where the board's design was made")
    parser.add_argument("--rebuilt", action="store_true", help="compare with a rebuild from the sources, too")
    parser.add_argument("--write", action="store_true", help="write report.md too")
    options = parser.parse_args()
    folder = options.folder / options.name
    started = time.perf_counter()
    with tempfile.TemporaryDirectory(dir=options.folder) as work:
        checks = verify(options.name, folder, Path(work), rebuilt=options.rebuilt)
    board = build.read_board(options.name)
    described = build.describe(board, options.name, board["seed"], folder)
    text = report(described, board["title"], checks, time.perf_counter() - started)
    print(text, end="")
    if options.write:
        (build.DESIGNS / options.name / "report.md").write_text(text)
    return 0 if all(holds for _, holds in checks) else 1


if __name__ == "__main__":
    sys.exit(main())
