from __future__ import annotations

import asyncio

import pytest


@pytest.fixture
def run():
    """Run a coroutine to its end, within a minute."""
    return lambda coroutine: asyncio.run(asyncio.wait_for(coroutine, 60))
