"""The release's text comes from the changelog, and a tag without an entry is refused."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / ".github" / "release_notes.py"
CHANGES = "# Changes\n\n## 0.3.0\n\n## 0.2.0 (2026-01-02)\n\n- A thing.\n- Another.\n\n## 0.1.0\n\nThe first.\n"


def notes(folder: Path, tag: str, version: str) -> subprocess.CompletedProcess[str]:
    (folder / "voxrt").mkdir()
    (folder / "voxrt" / "__init__.py").write_text(f'"""Doc."""\n\n__version__ = "{version}"\n')
    (folder / "CHANGELOG.md").write_text(CHANGES)
    return subprocess.run([sys.executable, SCRIPT, tag], cwd=folder, capture_output=True, text=True, check=False)


def test_the_entry_is_printed_without_its_heading(tmp_path):
    done = notes(tmp_path, "v0.2.0", "0.2.0")
    assert (done.returncode, done.stdout, done.stderr) == (0, "- A thing.\n- Another.\n", "")


def test_the_last_entry_is_printed(tmp_path):
    assert notes(tmp_path, "v0.1.0", "0.1.0").stdout == "The first.\n"


def test_a_tag_that_is_not_the_version_is_refused(tmp_path):
    done = notes(tmp_path, "v0.2.0", "0.1.0")
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == "release: the tag is v0.2.0 and voxrt/__init__.py has 0.1.0\n"


def test_a_missing_entry_is_refused(tmp_path):
    done = notes(tmp_path, "v0.4.0", "0.4.0")
    assert done.stderr == "release: CHANGELOG.md has no entry under '## 0.4.0': write one before the tag\n"


def test_an_empty_entry_is_refused(tmp_path):
    assert notes(tmp_path, "v0.3.0", "0.3.0").returncode == 1
