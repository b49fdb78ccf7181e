"""What becomes of every development asset, against the page that documents it."""

import subprocess
import sys
from difflib import unified_diff
from pathlib import Path

from assets import asset

DOCS = Path(__file__).resolve().parents[2] / "docs"


def test_every_asset_is_built_or_refused_as_documented():
    asset("README.md")
    script = DOCS / "make_assets_table.py"
    done = subprocess.run([sys.executable, script, "--print"], capture_output=True, text=True, timeout=900, check=True)
    documented = (DOCS / "assets.md").read_text(encoding="utf-8")
    changes = list(
        unified_diff(documented.splitlines(), done.stdout.splitlines(), "documented", "found", "", "", 0, "")
    )
    assert not changes, "\n".join([*changes, f"write the page anew with {script.name} where this is meant"])
    assert done.stdout.count("\n| `") == 215
    assert "FAILED" not in done.stdout
