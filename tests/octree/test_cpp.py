"""The C++ libraries as others build them; `make sanitize` builds the example too, without CMake."""

import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.skipif(not (shutil.which("cmake") and shutil.which("c++")), reason="no CMake or no C++ compiler")
def test_the_example_builds_from_the_sources(tmp_path):
    configure = ["cmake", "-S", ROOT / "examples" / "cpp", "-B", tmp_path]
    configured = subprocess.run(configure, check=False, capture_output=True, text=True)
    if "or higher is required" in configured.stderr:
        pytest.skip("an old CMake")
    assert configured.returncode == 0, configured.stderr
    subprocess.run(["cmake", "--build", tmp_path, "--parallel", "2"], check=True, capture_output=True)
    told = subprocess.run([tmp_path / "ask_octree"], check=True, capture_output=True, text=True)
    assert "a ray meets material" in told.stdout
