"""Designs for FPGA boards: a scene on the monitor without a host. ``docs/ecp5_boards.md`` is their reference."""
