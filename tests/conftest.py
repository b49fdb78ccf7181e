"""What every test runs under."""

import asyncio
import inspect
import itertools
import os
import signal
import sysconfig
from pathlib import Path

import hypothesis
import pytest

import voxrt

# One fixed sequence of examples, so that a failure seen once is seen again; no deadlines: slow machines pass too.
hypothesis.settings.register_profile("voxrt", derandomize=True, deadline=None, database=None)
hypothesis.settings.load_profile("voxrt")

# A shell starts background jobs deaf to Ctrl-C, and what these start inherits that: tests of interruption would fail.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

if os.environ.get("VOXRT_EXPECT_INSTALLED"):
    installed = Path(sysconfig.get_paths()["platlib"])
    assert Path(voxrt.__file__).is_relative_to(installed), f"testing {voxrt.__file__}, not the wheel in {installed}"


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem):
    """Run a test that is a coroutine to its end, within two minutes."""
    if not inspect.iscoroutinefunction(pyfuncitem.obj):
        return None
    arguments = {name: pyfuncitem.funcargs[name] for name in inspect.signature(pyfuncitem.obj).parameters}
    asyncio.run(asyncio.wait_for(pyfuncitem.obj(**arguments), 120))
    return True


_folder_numbers = itertools.count()


@pytest.fixture
def tmp_path(tmp_path):
    """Give each test a folder whose name no other test of this process has had.

    Folders of passed tests are removed, and pytest uses their names again. USD keeps layers by their paths, and it
    frees them in threads of its own.
    """
    folder = tmp_path / str(next(_folder_numbers))
    folder.mkdir()
    return folder
