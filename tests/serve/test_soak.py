"""A short run of the load test bench/soak.py, with each of its attacks once."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

BENCH = Path(__file__).parents[2] / "bench"


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="reads a process's memory from /proc")
def test_every_attack_once():
    attacks = len(re.findall(r'^    "[^"]+": \w+,$', (BENCH / "attacks.py").read_text(), re.MULTILINE))
    command = [sys.executable, BENCH / "soak.py", "--minutes", "0.05", "--attacks", str(attacks)]
    finished = subprocess.run(command, capture_output=True, text=True, check=False)
    assert "| attacks |" in finished.stdout, finished.stdout + finished.stderr
    counted = dict(re.findall(r"^\| (.+?) \| ([\d,]+)(?: lines)? \|$", finished.stdout, re.MULTILINE))
    assert counted["attacks"] == str(attacks)
    assert counted["viewers"] == "8"
    assert counted["what the server logged"] == "0"
    assert int(counted["scenes uploaded"]) > 0
    assert int(counted["frames received"].replace(",", "")) > 8 * attacks
