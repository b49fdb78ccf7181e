"""The named configurations of the core, and the files that it is made of.

``configurations.json`` holds the default of each parameter once, and for each configuration what differs from them.
``voxrt.f`` lists the source files in the order in which tools must read them. The sources include `HEADER`.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

RTL = Path(__file__).resolve().parent
TOP = "voxrt_core"
HEADER = RTL / "voxrt_assert.svh"
PARAMETERS = (
    "Lanes",
    "MaxDepth",
    "PositionBits",
    "BlockBits",
    "MemoryForm",
    "L1SetBits",
    "L2SetBits",
    "Light",
    "Mirrors",
    "RayClocks",
    "Lod",
)
_SIMULATION = "SimulationBlockBits"


class ConfigurationError(ValueError):
    """A file of configurations that cannot be used, in one line."""


@dataclass(frozen=True)
class Configuration:
    """A named set of parameters of the core."""

    name: str
    parameters: dict[str, int]
    """Value of each parameter of module voxrt_core, by its name there."""
    simulation_block_bits: int
    """BlockBits of the simulation that is compiled when the package is built: previews need more memory than a part."""

    @property
    def words(self) -> int:
        """Words of 32 bits that the octree memory holds: word 0 and 2**BlockBits blocks of 8."""
        return 1 + (8 << self.parameters["BlockBits"])

    @property
    def features(self) -> tuple[str, ...]:
        """What it can do beside faces: of light, mirrors, lod."""
        return tuple(name.lower() for name in ("Light", "Mirrors", "Lod") if self.parameters[name])


def read_configurations(path: Path = RTL / "configurations.json") -> dict[str, Configuration]:
    """Read the configurations, by name, in the order of the file.

    Parameters
    ----------
    path
        A file such as ``configurations.json``.

    Raises
    ------
    ConfigurationError
        The file has a key that is not known, lacks a default, or has a value that is not a whole number.

    Examples
    --------
    >>> read_configurations()["octo"].parameters["Lanes"]
    8
    """
    read = json.loads(path.read_text())
    _check_keys(read, ("defaults", "configurations"), path.name)
    defaults = _whole_numbers(read["defaults"], f"{path.name}: defaults")
    for key in (*PARAMETERS, _SIMULATION):
        if key not in defaults:
            raise ConfigurationError(f"{path.name}: defaults: {key} is missing; give it a whole number")
    configurations = {}
    for name, differing in read["configurations"].items():
        values = {**defaults, **_whole_numbers(differing, f"{path.name}: configurations: {name}")}
        parameters = {key: values[key] for key in PARAMETERS}
        configurations[name] = Configuration(name, parameters, values[_SIMULATION])
    return configurations


def list_sources() -> list[Path]:
    """Give the core's source files in the order in which tools must read them: packages first."""
    return [RTL / line for line in (RTL / "voxrt.f").read_text().splitlines() if line.endswith(".sv")]


def _check_keys(read: dict[str, Any], known: tuple[str, ...], place: str) -> None:
    for key in read:
        if key not in known:
            raise ConfigurationError(f"{place}: key {key!r} is not known; there are {', '.join(known)}")


def _whole_numbers(read: dict[str, Any], place: str) -> dict[str, int]:
    _check_keys(read, (*PARAMETERS, _SIMULATION), place)
    for key, value in read.items():
        if type(value) is not int:
            raise ConfigurationError(f"{place}: {key} is {value!r}; write a whole number")
    return read
