"""The C++ libraries as others build them; `make sanitize` builds the example too, without CMake."""

import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


@pytest.mark.skipif(not (shutil.which("cmake") and shutil.which("c++")), reason="no CMake or no C++ compiler")
def test_the_example_builds_from_the_sources(tmp_path):
    def cmake(*arguments: str) -> None:
        subprocess.run(["cmake", *arguments], check=True, capture_output=True, timeout=600)

    cmake("-S", str(ROOT / "examples" / "cpp"), "-B", str(tmp_path))
    cmake("--build", str(tmp_path), "--parallel", "2")
    told = subprocess.run([tmp_path / "ask_octree"], check=True, capture_output=True, text=True)
    assert "a ray meets material" in told.stdout
