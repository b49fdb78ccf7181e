"""The scripts of the manual stand in docs/ and docs/walk/, beside the pages."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from fakes.commands import built, folder, process, voxrt  # noqa: F401

DOCS = Path(__file__).resolve().parents[2] / "docs"


@pytest.fixture(scope="session", autouse=True)
def _docs_on_the_path():
    before = list(sys.path)
    sys.path[:0] = [str(DOCS), str(DOCS / "walk")]
    yield
    sys.path[:] = before
