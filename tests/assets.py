"""Public files of other people that tests read: a skip with a message where they are not here.

``assets.tsv`` has their origins; ``make assets`` lists what is missing.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest
from list_assets import ROOT

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

ABSENT = f"no public files below {ROOT}: `make assets` says where to get them, VOXRT_ASSETS where they stand"


def asset(name: str) -> Path:
    """The asset `name` (a path below the folder of assets); skips the test where it is absent."""
    path = ROOT / name
    if not path.exists():
        pytest.skip(f"no {name} below {ROOT}: `make assets` says where to get it" if ROOT.exists() else ABSENT)
    return path


def need_assets() -> None:
    """Skip the calling module, whose tests all read assets, where there are none."""
    if not ROOT.exists():
        pytest.skip(ABSENT, allow_module_level=True)


def over_assets(names: str | tuple[str, ...], values: Sequence[object]) -> pytest.MarkDecorator:
    """As ``pytest.mark.parametrize``, for a test that reads assets; one skip in its place where there are none."""
    if ROOT.exists():
        return pytest.mark.parametrize(names, values)
    count = 1 if isinstance(names, str) else len(names)
    return pytest.mark.parametrize(
        names, [pytest.param(*[None] * count, marks=pytest.mark.skip(reason=ABSENT), id="absent")]
    )
