"""Devices without a board: the exact model and the verilated core."""
