"""What a core in plain Verilog says of itself."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import os

_READ_CLOCKS = {0: 3, 1: 6}  # by MemoryForm, from an address of the memory port to its word


class VerilogFileError(ValueError):
    """A file that is no core which the wrappers can connect, in one line."""


def read_parameters(verilog: str | os.PathLike[str]) -> dict[str, int]:
    """Read the parameters of a core from the head of its file.

    Parameters
    ----------
    verilog
        A file that ``voxrt core --config NAME --verilog FILE`` has written.

    Returns
    -------
    dict
        Value by name, as ``configurations.json`` has them.

    Raises
    ------
    VerilogFileError
        The file is another, or the core's octree is in an external memory.
    """
    path = Path(verilog)
    with path.open() as file:
        head = " ".join(file.readline().removeprefix("//").strip() for _ in range(16))
    found = re.search(r"configuration \w+: ((?:\w+ \d+, )*\w+ \d+)\.", head)
    if found is None:
        raise VerilogFileError(f"{path}: is no core; write one: voxrt core --config tiny --verilog {path}")
    parameters = {name: int(value) for name, value in re.findall(r"(\w+) (\d+)", found[1])}
    if parameters["MemoryForm"] not in _READ_CLOCKS:
        raise VerilogFileError(f"{path}: its octree is in an external memory, which this wrapper does not connect")
    return parameters


def read_clocks(parameters: dict[str, int]) -> int:
    """Give the clocks from an address of the memory port to its word."""
    return _READ_CLOCKS[parameters["MemoryForm"]]


def memory_bytes(parameters: dict[str, int]) -> int:
    """Give the bytes of address space that the memory port takes: a power of two."""
    return 4 << (parameters["BlockBits"] + 4)
