"""The wrappers and the script for Vivado, as far as that can be known without it."""

from __future__ import annotations

import re
import shutil
import subprocess

import pytest

from voxrt.rtl.configurations import RTL, read_configurations

VIVADO = RTL / "vivado"
BOARDS = ("pynq-z1", "aup-zu3")
CONFIGURATIONS = ("z1", "cached1", "cached4", "cached8", "cached16")
PORT = re.compile(r"^ +(input|output) +(?:logic|wire) +(?:\[ ?(\d+):0\] +)?(\w+)", re.MULTILINE)
CONNECTION = re.compile(r"^ +\.(\w+) *\((.*)\)", re.MULTILINE)

# Every command of Vivado says what it was called with, in a line, and gives its last argument.
FAKE = r"""
proc unknown args {{puts [string map {{\n " "}} [join $args |]]; return [lindex $args end]}}
set argv {{{arguments}}}
source {{{script}}}
"""


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
    for name in CONFIGURATIONS[1:]:
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


def run_script(tmp_path, *arguments):
    if shutil.which("tclsh") is None:
        pytest.skip("there is no tclsh: apt install tcl")
    main = tmp_path / "main.tcl"
    main.write_text(FAKE.format(arguments=" ".join(arguments), script=VIVADO / "build.tcl"))
    return subprocess.run(["tclsh", main], capture_output=True, text=True, check=False)


@pytest.mark.parametrize("board", BOARDS)
@pytest.mark.parametrize("configuration", CONFIGURATIONS)
def test_the_script_connects_all_there_is(board, configuration, tmp_path):
    """Its logic, with commands that only say what they were called with."""
    ran = run_script(tmp_path, board, configuration)
    assert ran.returncode == 0, ran.stderr
    calls = [line.split("|") for line in ran.stdout.splitlines()]
    cells = {call[-1]: call[-2] for call in calls if call[0] == "create_bd_cell"}
    cached = configuration != "z1"
    assert cells["core"] == ("voxrt_zynq_cached" if cached else "voxrt_pynq_z1")
    assert cells.keys() == {"ps", "core", "vdma"} | (set() if cached else {"memory"})
    (files,) = (call[1].split() for call in calls if call[0] == "add_files")
    assert {name.rsplit("/", 1)[1] for name in files} >= {"voxrt_core.sv", "voxrt_registers.sv", f"{cells['core']}.v"}
    automated = {call[-1]: call[-2] for call in calls if call[:2] == ["apply_bd_automation", "-rule"]}
    suffix = "" if board == "pynq-z1" else "_FPD"
    masters = {"vdma/M_AXI_S2MM": "HP0"} | ({"core/m_axi0": "HP1", "core/m_axi1": "HP3"} if cached else {})
    for master, port in masters.items():
        assert automated[f"ps/S_AXI_{port}{suffix}"] == f"Master /{master} Clk Auto"
    ((*_, settings, _),) = (call for call in calls if call[0] == "set_property" and call[-1] == "ps")
    for port, on_ultrascale in (("HP1", "PSU__USE__S_AXI_GP3"), ("HP3", "PSU__USE__S_AXI_GP5")):
        setting = on_ultrascale if suffix else f"PCW_USE_S_AXI_{port}"
        assert (f"CONFIG.{setting} 1" in settings) == cached
    lanes = [call[2] for call in calls if call[:2] == ["set_property", "CONFIG.Lanes"]]
    assert lanes == ([configuration.removeprefix("cached")] if cached else [])


def test_what_the_script_makes_by_default(tmp_path):
    assert run_script(tmp_path).stdout == run_script(tmp_path, "pynq-z1", "z1").stdout


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (["abacus"], "there is no board abacus: name pynq-z1 or aup-zu3"),
        (["pynq-z1", "cached2"], "there is no configuration cached2: name z1, cached1, cached4, cached8 or cached16"),
    ],
)
def test_the_script_refuses(arguments, problem, tmp_path):
    ran = run_script(tmp_path, *arguments)
    assert ran.returncode == 1
    assert ran.stderr.splitlines()[0] == problem
