"""Cells of a placed ECP5 netlist, as yosys and nextpnr write them."""

from __future__ import annotations

PADS = 1000  # nets at pins, less those within


def constant(net, value):
    settings = {"INITVAL": str(value) * 16}
    cell = {"type": "TRELLIS_COMB", "parameters": settings, "port_directions": {"F": "output"}}
    return cell | {"connections": {"F": [net]}}


def pads(*wires):
    """Ports and the cells at their pins; a wire has a name, a direction, its first net and its bits."""
    ports, cells = {}, {}
    for name, direction, first, bits in wires:
        ports[name] = {"direction": direction, "bits": [PADS + first + i for i in range(bits)]}
        pin, way = ("O", "output") if direction == "input" else ("I", "input")
        for i in range(bits):
            cells[f"{name}{i}"] = {
                "type": "TRELLIS_IO",
                "parameters": {"DIR": direction.upper()},
                "port_directions": {pin: way, "B": direction},
                "connections": {pin: [first + i], "B": [PADS + first + i]},
            }
    return ports, cells


def netlist(ports, cells):
    return {"modules": {"top": {"ports": ports, "cells": cells}}}
