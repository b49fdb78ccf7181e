"""Public files of other people that tests read: a skip with a message where they are not here.

``assets.tsv`` has their origins; ``make assets`` lists what is missing.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from collections.abc import Sequence

ROOT = Path(os.environ.get("VOXRT_ASSETS", Path(__file__).resolve().parents[1].parent / "shared" / "assets"))
ABSENT = f"no public files below {ROOT}: `make assets` says where to get them, VOXRT_ASSETS where they stand"


def asset(name: str) -> Path:
    """The asset `name` (a path below the folder of assets); skips the test where it is absent."""
    path = ROOT / name
    if not path.exists():
        pytest.skip(f"no {name} below {ROOT}: `make assets` says where to get it" if ROOT.exists() else ABSENT)
    return path


def over_assets(names: str | tuple[str, ...], values: Sequence[object]) -> pytest.MarkDecorator:
    """As ``pytest.mark.parametrize``, for values that name assets; one skip in their place where there are none."""
    if ROOT.exists():
        return pytest.mark.parametrize(names, values)
    count = 1 if isinstance(names, str) else len(names)
    return pytest.mark.parametrize(
        names, [pytest.param(*[None] * count, marks=pytest.mark.skip(reason=ABSENT), id="absent")]
    )
