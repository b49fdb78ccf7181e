"""What every test runs under."""

import os
import sysconfig
from pathlib import Path

import hypothesis

import voxrt

# One fixed sequence of examples, so that a failure seen once is seen again; no deadlines: slow machines pass too.
hypothesis.settings.register_profile("voxrt", derandomize=True, deadline=None, database=None)
hypothesis.settings.load_profile("voxrt")

if os.environ.get("VOXRT_EXPECT_INSTALLED"):
    installed = Path(sysconfig.get_paths()["platlib"])
    assert Path(voxrt.__file__).is_relative_to(installed), f"testing {voxrt.__file__}, not the wheel in {installed}"
