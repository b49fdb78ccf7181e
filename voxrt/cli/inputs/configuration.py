"""The configuration of the hardware that a command line names."""

from __future__ import annotations

from voxrt.cli.terminal.errors import UsageError
from voxrt.rtl.configurations import Configuration, read_configurations


def find_configuration(name: str) -> Configuration:
    """Find a configuration of the core by what ``--config`` says."""
    configurations = read_configurations()
    if name not in configurations:
        raise UsageError(f"--config {name}: there is no such configuration; name one of {', '.join(configurations)}")
    return configurations[name]
