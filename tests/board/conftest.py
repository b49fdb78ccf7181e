"""What tests of boards share."""

from __future__ import annotations

from contextlib import ExitStack

import pytest
from fakes.board_agent import Boards


@pytest.fixture
def open_board():
    """Opens the fake PYNQ board that is installed, over TCP."""
    with ExitStack() as stack:
        boards = Boards(stack)
        stack.callback(boards.close)
        yield boards
