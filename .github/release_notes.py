"""Print the changelog's entry for a tag, and fail unless tag, version and changelog agree.

Usage: ``python .github/release_notes.py v0.2.0 > notes.md``. It reads ``CHANGELOG.md`` and ``voxrt/__init__.py`` of the
folder that it is started in.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path


def release_notes(tag: str, changelog: str, package: str) -> str:
    r"""Return the text below the heading ``## VERSION`` of the changelog.

    Parameters
    ----------
    tag
        The tag of the release, ``v`` and the version.
    changelog
        The text of ``CHANGELOG.md``.
    package
        The text of ``voxrt/__init__.py``, where the version stands.

    Raises
    ------
    ValueError
        The tag is not the package's version, or the changelog has no entry for it.

    Examples
    --------
    >>> release_notes("v1.2.0", "# Changes\n\n## 1.2.0\n\nFaster.\n\n## 1.1.0\n", '__version__ = "1.2.0"')
    'Faster.\n'
    """
    versions = re.findall(r'^__version__ = "(.+)"$', package, re.MULTILINE)
    if [tag] != [f"v{version}" for version in versions]:
        raise ValueError(f"the tag is {tag} and voxrt/__init__.py has {', '.join(versions) or 'no version'}")
    _, *entries = re.split(r"^## ", changelog, flags=re.MULTILINE)
    for entry in entries:
        heading, _, text = entry.partition("\n")
        if heading.split()[:1] == [tag.removeprefix("v")] and text.strip():
            return text.strip() + "\n"
    raise ValueError(f"CHANGELOG.md has no entry under '## {tag.removeprefix('v')}': write one before the tag")


if __name__ == "__main__":
    try:
        sys.stdout.write(
            release_notes(sys.argv[1], Path("CHANGELOG.md").read_text(), Path("voxrt/__init__.py").read_text())
        )
    except ValueError as error:
        sys.exit(f"release: {error}")
