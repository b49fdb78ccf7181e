"""The soak of bench/soak.py, a few rounds of it."""

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
        ("visits", 4),
        ("scenes put on", 1),
        ("strangers", 5),
        ("visitors who read nothing", 1),
        ("visitors who talk nonsense", 1),
        ("pictures for the original's client", 1),
    ):
        assert counted[what] == str(times * rounds), what
    assert int(counted["frames seen"].replace(",", "")) >= rounds * (10 + 4 + 4)
