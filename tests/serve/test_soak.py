"""A few rounds of the load test bench/soak.py."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

SOAK = Path(__file__).parents[2] / "bench" / "soak.py"


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="reads a process's memory from /proc")
def test_rounds():
    rounds = 5
    command = [sys.executable, SOAK, "--rounds", str(rounds)]
    finished = subprocess.run(command, capture_output=True, text=True, check=False)
    assert finished.returncode == 0, finished.stdout + finished.stderr
    counted = dict(re.findall(r"^\| (.+?) \| ([\d,]+) \|$", finished.stdout, re.MULTILINE))
    for what, times in (
        ("rounds", 1),
        ("short connections", 4),
        ("scenes uploaded", 1),
        ("faulty connections", 5),
        ("clients that read nothing", 1),
        ("clients that send malformed messages", 1),
        ("pictures by the legacy protocol", 1),
    ):
        assert counted[what] == str(times * rounds), what
    assert int(counted["frames received"].replace(",", "")) >= rounds * (10 + 4 + 4)
