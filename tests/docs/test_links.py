"""Links between the files of the repository lead somewhere, and the front page stays short."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[2]
PAGES = [
    *sorted(REPOSITORY.glob("*.md")),
    REPOSITORY / "rtl" / "README.md",
    *(path for path in sorted((REPOSITORY / "docs").glob("*.md")) if path.name != "assets.md"),
]
LINK = re.compile(r"!?\[[^\]]*\]\(([^)#\s]+)(?:#[^)]*)?\)")
MADE = ("gallery/", "study/", "measured/", "reference/", "walk/pictures/")
"""Parts of the manual that are written when it is built; its build finds links that lead nowhere."""


@pytest.mark.parametrize("page", PAGES, ids=lambda path: str(path.relative_to(REPOSITORY)))
def test_links_lead_somewhere(page):
    for target in LINK.findall(page.read_text(encoding="utf-8")):
        if "://" in target or (page.parent.name == "docs" and target.startswith(MADE)):
            continue
        assert (page.parent / target).exists(), target


def test_the_front_page_is_short():
    text = (REPOSITORY / "README.md").read_text(encoding="utf-8")
    assert len(text.split()) <= 950


def test_the_manual_speaks_of_frames_per_second_nowhere_but_for_one_lane():
    for page in PAGES:
        for line in page.read_text(encoding="utf-8").splitlines():
            if re.search(r"\d[\d.,]* (?:frames (?:a|per) second|fps)", line):
                assert "one lane" in line or "one-lane" in line, f"{page.name}: {line}"
