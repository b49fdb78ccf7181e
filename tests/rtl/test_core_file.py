"""The FuseSoC core file names the RTL that there is, packages before what imports them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

RTL = Path(__file__).parents[2] / "rtl"


@pytest.mark.skipif(not RTL.is_dir(), reason="the RTL is not beside the tests")
def test_it_lists_every_file_once():
    listed = re.findall(r"- (\S+\.sv)", (RTL / "voxrt.core").read_text())
    present = [path.name for path in RTL.glob("*.sv")] + [
        f"generated/{path.name}" for path in RTL.glob("generated/*.sv")
    ]
    assert sorted(listed) == sorted(present)
    assert listed[:2] == ["voxrt_pkg.sv", "generated/voxrt_registers_pkg.sv"]
