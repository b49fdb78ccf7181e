"""The file lists, voxrt.f and that of FuseSoC, name the RTL that there is, packages before what imports them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from voxrt.rtl import configurations
from voxrt.rtl.configurations import list_sources

RTL = Path(__file__).parents[2] / "rtl"


@pytest.mark.skipif(not RTL.is_dir(), reason="the RTL is not beside the tests")
def test_they_list_every_file_once():
    listed = [str(path.relative_to(configurations.RTL)) for path in list_sources()]
    present = [path.name for path in RTL.glob("*.sv")] + [
        f"generated/{path.name}" for path in RTL.glob("generated/*.sv")
    ]
    assert sorted(listed) == sorted(present)
    assert listed[:2] == ["voxrt_pkg.sv", "generated/voxrt_registers_pkg.sv"]
    assert re.findall(r"- (\S+\.sv)", (RTL / "voxrt.core").read_text()) == listed
    assert "toplevel: voxrt_core" in (RTL / "voxrt.core").read_text()


def test_the_package_has_what_it_lists():
    assert all(path.is_file() for path in list_sources())
    assert list_sources()[0].name == "voxrt_pkg.sv"
