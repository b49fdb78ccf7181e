"""Boards in simulation: the sources, or the netlist after place and route, with a monitor and a host."""
