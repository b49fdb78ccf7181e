"""What becomes of every development asset, against the page that documents it."""

import re
import subprocess
import sys
from difflib import unified_diff
from importlib.metadata import version
from pathlib import Path

from assets import asset

DOCS = Path(__file__).resolve().parents[2] / "docs"


def test_every_asset_is_built_or_refused_as_documented():
    asset("gltf")
    script = DOCS / "make_assets_table.py"
    done = subprocess.run([sys.executable, script, "--print"], capture_output=True, text=True, timeout=900, check=True)
    documented, found = (DOCS / "assets.md").read_text(encoding="utf-8").splitlines(), done.stdout.splitlines()
    if f"usd-core {version('usd-core')}." not in documented:  # it words its problems anew now and then
        documented, found = (
            [line for line in page if not re.search(r"^usd-core|^[|].*[.]usd[acz]?`", line)]
            for page in (documented, found)
        )
    changes = list(unified_diff(documented, found, "documented", "found", "", "", 0, ""))
    assert not changes, "\n".join([*changes, f"write the page anew with {script.name} where this is meant"])
    assert done.stdout.count("\n| `") == 215
    assert "FAILED" not in done.stdout
