"""Memory that a server frees goes back to the system."""

import platform
import subprocess
import sys

import pytest

SCRIPT = """
import numpy as np
from voxrt.serve.freed_memory import return_freed_memory

def resident():
    with open("/proc/self/status") as file:
        return next(int(line.split()[1]) for line in file if line.startswith("VmRSS")) / 1024

if {returns}:
    return_freed_memory()
np.ones(9 << 20, np.uint8)  # freed at once: glibc then counts as large what exceeds 9 MiB
before = resident()
arrays = [np.ones(8 << 20, np.uint8) for _ in range(4)]
kept = [bytearray(100_000) for _ in range(4)]  # above them
del arrays
print(resident() - before)
"""


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="the C library is not glibc")
@pytest.mark.parametrize("returns", [False, True])
def test_large_arrays_are_returned_when_they_are_freed(returns):
    script = SCRIPT.format(returns=returns)
    finished = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert (float(finished.stdout) < 4) == returns
