"""The file lists, voxrt.f, FuseSoC's and Bender's, name the RTL that there is, packages before what imports them.

FuseSoC's parameters are the core's. The IP-XACT has the registers that the Python map has.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

from voxrt.board.registers import MATERIALS, REGISTERS
from voxrt.rtl import configurations
from voxrt.rtl.configurations import list_sources

RTL = Path(__file__).parents[2] / "rtl"
NOT_CORE = {"coverage", "first_frame", "formal"}


@pytest.mark.skipif(not RTL.is_dir(), reason="the RTL is not beside the tests")
def test_they_list_every_file_once():
    listed = [str(path.relative_to(configurations.RTL)) for path in list_sources()]
    present = {str(path.relative_to(RTL)) for path in RTL.rglob("*.sv") if path.parent.name not in NOT_CORE}
    assert sorted(listed) == sorted(present)
    assert listed[:2] == ["voxrt_pkg.sv", "generated/voxrt_registers_pkg.sv"]
    assert re.findall(r"[\w/]+\.sv(?=[,\n])", (RTL / "voxrt.core").read_text()) == listed
    assert re.findall(r"[\w/]+\.sv(?=[,\n])", (RTL / "Bender.yml").read_text()) == listed
    assert "toplevel: voxrt_core" in (RTL / "voxrt.core").read_text()


def test_the_package_has_what_it_lists():
    assert all(path.is_file() for path in list_sources())
    assert list_sources()[0].name == "voxrt_pkg.sv"


def test_fusesoc_knows_the_parameters_of_the_core():
    text = (configurations.RTL / "voxrt.core").read_text()
    listed = dict(
        re.findall(r"^  (\w+):\n    datatype: int\n    default: (\d+)\n    paramtype: vlogparam$", text, re.MULTILINE)
    )
    defaults = json.loads((configurations.RTL / "configurations.json").read_text())["defaults"]
    del defaults["SimulationBlockBits"]
    defaults["EndsFrames"] = 0  # no configuration sets it
    assert {name: int(value) for name, value in listed.items()} == defaults


@pytest.mark.skipif(shutil.which("bender") is None, reason="bender is not installed: cargo install bender")
def test_bender_lists_the_sources(tmp_path):
    """A package that depends on the folder gets all files, in order."""
    (tmp_path / "Bender.yml").write_text(
        f"package: {{ name: minimal }}\ndependencies: {{ voxrt: {{ path: {configurations.RTL.resolve()} }} }}\n"
    )
    subprocess.run(["bender", "update"], cwd=tmp_path, check=True, capture_output=True)
    command = ["bender", "script", "flist"]
    flist = subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True).stdout
    assert [Path(line) for line in flist.split()] == [path.resolve() for path in list_sources()]


def test_ip_xact_has_every_register():
    space = {"x": "http://www.accellera.org/XMLSchema/IPXACT/1685-2014"}
    root = ET.parse(configurations.RTL / "generated" / "voxrt_registers.xml").getroot()
    registers, materials = root.findall(".//x:addressBlock", space)

    def number(node, name):
        return int(node.findtext(f"x:{name}", "1", space).replace("'h", "0x"), 0)

    found = {}
    for register in registers.findall("x:register", space):
        name, offset = register.findtext("x:name", "", space), number(register, "addressOffset")
        fields = {
            field.findtext("x:name", "", space): (number(field, "bitOffset"), number(field, "bitWidth"))
            for field in register.findall("x:field", space)
        }
        count = number(register, "dim")
        for index in range(count):
            found[name if count == 1 else f"{name}[{index}]"] = (offset + 4 * index, fields)
    assert found == REGISTERS
    assert (number(materials, "baseAddress"), number(materials, "range")) == (MATERIALS, 1024)
    assert number(registers, "range") == MATERIALS
