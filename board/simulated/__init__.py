"""Devices that need no board: the exact model and the verilated core."""
