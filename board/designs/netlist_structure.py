"""A digest of what a netlist of yosys is, whatever its cells and nets are called and in which order they stand.

Two netlists with equal digests are the same circuit, but for parts that no round of the refinement tells apart.
After a change of the sources it says whether the design must be placed anew.
"""

from __future__ import annotations

import hashlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Mapping

_ROUNDS = 12


def structure_digest(netlist: Mapping[str, Any], top: str) -> str:
    """Give the SHA-256 of a netlist's structure: types and parameters of cells, and how pins are connected.

    Each net begins with the ports at it. In each round, a cell's label becomes the hash of its type, its parameters
    and the labels of its nets, and a net's label the hash of the labels of the pins at it (colour refinement,
    Weisfeiler and Leman). The digest is of all labels, sorted.

    Parameters
    ----------
    netlist
        The JSON of yosys, flat.
    top
        The module.
    """
    module = netlist["modules"][top]
    nets: dict[Any, bytes] = {}
    for name, port in sorted(module["ports"].items()):
        for index, bit in enumerate(port["bits"]):
            nets[bit] = _hash(nets.get(bit, b""), f"{port['direction']} {name} {index}".encode())
    cells = [
        (
            _hash(cell["type"].encode(), repr(sorted(cell["parameters"].items())).encode()),
            [
                (f"{pin} {index}".encode(), bit)
                for pin, bits in sorted(cell["connections"].items())
                for index, bit in enumerate(bits)
            ],
        )
        for cell in module["cells"].values()
        if cell["type"] != "$scopeinfo"
    ]
    labels: list[bytes] = []
    for _ in range(_ROUNDS):
        labels = []
        pins: dict[Any, list[bytes]] = {}
        for kind, connections in cells:
            label = _hash(kind, *(pin + _label(nets, bit) for pin, bit in connections))
            labels.append(label)
            for pin, bit in connections:
                pins.setdefault(bit, []).append(label + pin)
        nets |= {bit: _hash(_label(nets, bit), *sorted(at)) for bit, at in pins.items() if isinstance(bit, int)}
    return hashlib.sha256(b"".join(sorted(labels))).hexdigest()


def _label(nets: Mapping[Any, bytes], bit: int | str) -> bytes:
    return nets.get(bit, b"-") if isinstance(bit, int) else bit.encode()


def _hash(*parts: bytes) -> bytes:
    return hashlib.blake2b(b"\0".join(parts), digest_size=16).digest()
