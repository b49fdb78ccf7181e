"""The wave of a ray in the chapter "How a ray walks an octree": what the lane's signals show, stage by stage.

The simulated hardware traces the ray.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.sim.wave import CLOCK, record_wave

if TYPE_CHECKING:
    import voxrt
    from voxrt import sim

STEP = 3  # of the real ray: an empty leaf
ACTIONS = ("Retry", "Descend", "Leave", "Finish")  # as action_e of voxrt_pkg.sv numbers them


def table(rom: voxrt.Rom, path: sim.RayPath) -> str:
    """Give the signals of one word of a ray as a table, and those of the next word's first stage."""
    wave = record_wave(rom, path)
    start = wave.words[STEP - 1]

    def at(stage: int, name: str) -> int:
        return wave.lane(name).at(start + stage * CLOCK)

    def axes(stage: int, name: str) -> str:
        return ", ".join(f"{at(stage, f'{name}[{axis}]'):,}" for axis in range(3))

    rows = [
        (0, "`mem_read_o`, `mem_address_o`", f"{at(0, 'mem_read_o')}, {at(0, 'mem_address_o'):#x}: a word is read"),
        (2, "`leaf`, `action`", f"{at(2, 'leaf')}, {ACTIONS[at(2, 'action')]}: an empty leaf"),
        (6, "`key_time6_q`, `key_face6_q`", f"{at(6, 'key_time6_q'):,}, {'xyz'[at(6, 'key_face6_q')]}: the ray's key"),
        (6, "`time6`", f"{axes(6, 'time6')}: T of the far planes"),
        (9, "`exit_face9`", f"{'xyz'[at(9, 'exit_face9')]}: the smallest T; it becomes the key"),
        (11, "`corner11`, `octant11`", f"{axes(11, 'corner11')}; {at(11, 'octant11'):03b}: the next cell, mirrored"),
        (12, "`mem_read_o`, `mem_address_o`", f"{at(12, 'mem_read_o')}, {at(12, 'mem_address_o'):#x}: the next word"),
    ]
    lines = ["| time, ns | stage | signals | values |", "|--:|--:|---|---|"]
    lines += [f"| {start + stage * CLOCK:,} | {stage % 12} | {names} | {values} |" for stage, names, values in rows]
    return "\n".join(lines) + "\n"
