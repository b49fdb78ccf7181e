"""A module of ours with a bench in C++, compiled by Verilator."""

from __future__ import annotations

import os
import subprocess
from typing import TYPE_CHECKING

from oracles.verilator import packaged_verilator

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path


def compile_bench(top: str, sources: Sequence[Path], folder: Path, *options: str) -> Path:
    """Compile SystemVerilog and C++ in a folder; give the program. The class of the module is ``Vtop``."""
    verilator, variables = packaged_verilator()
    environment = {**os.environ, **variables}
    command = [verilator, "--cc", "--exe", "--top-module", top, "--prefix", "Vtop", "-Mdir", folder]
    command += ["-Wno-fatal", "-Wno-lint", *options]
    subprocess.run([*command, *sources], env=environment, check=True, stdout=subprocess.DEVNULL)
    make = ["make", "-s", "-C", folder, "-f", "Vtop.mk", "CFG_CXXFLAGS_PCH_I=-include", "OPT_FAST=-O1"]
    subprocess.run(make, env=environment, check=True)
    return folder / "Vtop"
