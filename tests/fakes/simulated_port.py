"""The serial port of a simulated board, for the link of the host."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from voxrt.board.designs.simulation.board_simulation import BoardSimulation

QUIET_CLOCKS = 100_000
"""Pixel clocks without a byte after which a read ends."""


class SimulatedPort:
    """A serial port (`write`, `read`, `close`); the board runs while a read waits."""

    def __init__(self, simulation: BoardSimulation, step: int = 400) -> None:
        self.simulation = simulation
        self.step = step
        self.waiting = b""

    def write(self, data: bytes) -> None:
        self.simulation.send(data)

    def read(self, count: int) -> bytes:
        quiet = 0
        while len(self.waiting) < count and quiet < QUIET_CLOCKS:
            self.simulation.run(self.step)
            came = self.simulation.received()
            quiet = 0 if came else quiet + self.step
            self.waiting += came
        data, self.waiting = self.waiting[:count], self.waiting[count:]
        return data

    def close(self) -> None:
        pass
