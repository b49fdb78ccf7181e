"""The wrappers for block designs of Vivado: ports and parameters are those of the core and its configurations."""

from __future__ import annotations

import re

import pytest

from voxrt.rtl.configurations import RTL, read_configurations

VIVADO = RTL / "vivado"
CACHED = ("cached1", "cached4", "cached8", "cached16")
PORT = re.compile(r"^ +(input|output) +(?:logic|wire) +(?:\[ *(\d+):0\] +)?(\w+)", re.MULTILINE)
CONNECTION = re.compile(r"^ +\.(\w+) *\((.*)\)", re.MULTILINE)


def ports(text):
    return {name: (direction, int(high or 0)) for direction, high, name in PORT.findall(text)}


@pytest.fixture(scope="module")
def core():
    return ports((RTL / "voxrt_core.sv").read_text())


@pytest.mark.parametrize(("wrapper", "absent"), [("voxrt_pynq_z1", "m_axi"), ("voxrt_zynq_cached", "bram")])
def test_a_wrapper_has_the_ports_of_the_core(core, wrapper, absent):
    """But for those of the memory that it does not have: outputs of these are open, inputs constant."""
    text = (VIVADO / f"{wrapper}.v").read_text()
    own = ports(text)
    assert len(core) > 50
    extra = {"bram_clk_i", "bram_rst_i"} & own.keys()  # of the interface, not of the core
    assert own.keys() - extra == {name for name in core if not name.startswith(absent) or name.startswith("m_axis")}
    assert all(own[name] == core[name] for name in own.keys() - extra)
    connections = dict(CONNECTION.findall(text[text.index("voxrt_core #(") :]))
    assert core.keys() < connections.keys()
    for name, (direction, high) in core.items():
        constant = "" if direction == "output" else rf"{high + 1}'[bd]0"
        assert re.fullmatch(name if name in own else constant, connections[name]), name


def test_the_cached_wrapper_has_the_parameters_of_the_configuration():
    text = (VIVADO / "voxrt_zynq_cached.v").read_text()
    own = {name: int(value) for name, value in re.findall(r"parameter integer (\w+) += (\d+)", text)}
    for name in CACHED:
        wanted = read_configurations()[name].parameters | {"Lanes": own["Lanes"]}
        assert wanted == {"MemoryForm": 2, "Light": 0, "Mirrors": 0, "RayClocks": 1} | own
    assert own["Lanes"] == read_configurations()["cached16"].parameters["Lanes"]
    connections = dict(CONNECTION.findall(text[: text.index(") u_core")]))
    assert connections == {name: name for name in own} | {"MemoryForm": "2"}


def test_interfaces_are_named_by_their_signals():
    for port in ("m_axi0", "m_axi1"):
        text = (VIVADO / "voxrt_zynq_cached.v").read_text()
        named = dict(re.findall(rf'aximm:1.0 {port} (\w+)" \*\)\n(?:  \(\*.*\n)?.* {port}_(\w+),', text))
        assert [name.lower() for name in named] == list(named.values())
        assert len(named) == 13
    assert "ASSOCIATED_BUSIF s_axil:m_axi0:m_axi1:m_axis" in text
