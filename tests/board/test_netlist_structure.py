"""The digest of a netlist: names and order do not count, all else does."""

from __future__ import annotations

import copy
import random

import pytest

from voxrt.board.designs.netlist_structure import structure_digest


def cell(kind, init, **pins):
    return {"type": kind, "parameters": {"INIT": init}, "connections": {pin: [bit] for pin, bit in pins.items()}}


NETLIST = {
    "modules": {
        "top": {
            "ports": {
                "clk": {"direction": "input", "bits": [2]},
                "d": {"direction": "input", "bits": [3, 4]},
                "q": {"direction": "output", "bits": [9]},
            },
            "cells": {
                "a": cell("LUT4", "0110", A=3, B=4, Z=5),
                "b": cell("TRELLIS_FF", "", CLK=2, DI=5, Q=6),
                "c": cell("LUT4", "1000", A=6, B=4, C="1", Z=7),
                "d": cell("TRELLIS_FF", "", CLK=2, DI=7, Q=9),
            },
        }
    }
}


def digest(change=None):
    netlist = copy.deepcopy(NETLIST)
    if change is not None:
        change(netlist["modules"]["top"]["cells"])
    return structure_digest(netlist, "top")


def test_names_numbers_and_order_do_not_count():
    netlist = copy.deepcopy(NETLIST)
    module = netlist["modules"]["top"]
    numbers = {bit: bit + 100 for bit in range(20)}
    for port in module["ports"].values():
        port["bits"] = [numbers[bit] for bit in port["bits"]]
    renamed = []
    for number, each in enumerate(module["cells"].values()):
        each["connections"] = {
            pin: [numbers.get(bit, bit) for bit in bits] for pin, bits in each["connections"].items()
        }
        renamed.append((f"other{number}", each))
    random.Random(1).shuffle(renamed)
    module["cells"] = {"scope": cell("$scopeinfo", "")} | dict(renamed)
    assert structure_digest(netlist, "top") == digest()


@pytest.mark.parametrize(
    "change",
    [
        lambda cells: cells["a"]["parameters"].update(INIT="0111"),
        lambda cells: cells["a"].update(type="PFUMX"),
        lambda cells: cells["c"]["connections"].update(A=[5]),
        lambda cells: cells["c"]["connections"].update(C=["0"]),
        lambda cells: cells["a"]["connections"].update(A=[4], B=[3]),
        lambda cells: cells.pop("c"),
        lambda cells: cells.update(e=cell("LUT4", "0110", A=3, B=4, Z=12)),
    ],
)
def test_any_other_change_counts(change):
    assert digest(change) != digest()
