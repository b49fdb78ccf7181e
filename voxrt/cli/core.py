"""``voxrt core``."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - cyclopts reads the signature
from typing import Annotated

from cyclopts import Parameter

from voxrt.boards.plain_verilog import STAGES, plain_verilog
from voxrt.cli.arguments import Messages
from voxrt.cli.configuration import find_configuration
from voxrt.cli.errors import UsageError
from voxrt.cli.messages import print_answer, summarize, tabulate
from voxrt.cli.progress import stage_bar
from voxrt.outputs import check_folder, writing
from voxrt.rtl.configurations import RTL, read_configurations


def core(
    *,
    path: Annotated[bool, Parameter(show_default=False)] = False,
    config: Annotated[str | None, Parameter(metavar="NAME")] = None,
    verilog: Annotated[Path | None, Parameter(metavar="FILE")] = None,
    reporting: Annotated[Messages, Parameter(name="*", show_default=False)] = Messages(),  # noqa: ARG001, B008
) -> None:
    """Show the configurations of the hardware, or give its sources to a design of your own.

    Without options it lists the configurations.

    Parameters
    ----------
    path
        Print the folder of the SystemVerilog sources. Its voxrt.f lists them in the order in which tools must read
        them; its README.md is their manual.
    config
        The configuration that --verilog writes.
    verilog
        A .v to write: the configuration as one file of plain Verilog, top module voxrt_core, for tools that do not
        read the SystemVerilog sources. yosys makes it.
    reporting
        How results are printed.
    """
    if path and (config or verilog):
        raise UsageError("--path excludes --config and --verilog")
    if (config is None) != (verilog is None):
        raise UsageError("--config and --verilog need each other")
    if path:
        print_answer(f"{RTL}\n")
    elif config is not None and verilog is not None:
        _write(config, verilog)
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
