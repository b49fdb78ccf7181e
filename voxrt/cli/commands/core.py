"""``voxrt core``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.boards.plain_verilog import STAGES, plain_verilog
from voxrt.cli.inputs.configuration import find_configuration
from voxrt.cli.terminal.errors import UsageError
from voxrt.cli.terminal.messages import print_answer, summarize, tabulate
from voxrt.cli.terminal.progress import stage_bar
from voxrt.export.outputs import check_folder, writing
from voxrt.rtl.configurations import RTL, read_configurations

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.options.board_commands import CoreCommand


def run(options: CoreCommand) -> None:
    """Show the configurations of the hardware, or give its sources to a design of your own."""
    if options.path and (options.config or options.verilog):
        raise UsageError("--path excludes --config and --verilog")
    if (options.config is None) != (options.verilog is None):
        raise UsageError("--config and --verilog need each other")
    if options.path:
        print_answer(f"{RTL}\n")
    elif options.config is not None and options.verilog is not None:
        _write(options.config, options.verilog)
    else:
        _list()


def _list() -> None:
    tabulate(
        ("configuration", "lanes", "depth", "octree words", "memory", "features"),
        [
            (
                each.name,
                str(each.parameters["Lanes"]),
                str(each.parameters["MaxDepth"]),
                f"{each.words:,}",
                ("private", "banked", "cached")[each.parameters["MemoryForm"]],
                " ".join(each.features),
            )
            for each in read_configurations().values()
        ],
        answer=True,
    )


def _write(name: str, file: Path) -> None:
    from voxrt.export.atomic import write_atomically  # noqa: PLC0415 - NumPy comes with it

    configuration = find_configuration(name)
    if file.suffix.lower() != ".v":
        raise UsageError(f"{file}: plain Verilog is written to a file that ends in .v")
    check_folder(file.parent)
    with stage_bar(len(STAGES)) as begin:
        text = plain_verilog(configuration, progress=begin)
    with writing(file):
        write_atomically(file, text.encode())
    summarize(f"{name}:", [("top", "voxrt_core, without parameters"), ("wrote", str(file))])
