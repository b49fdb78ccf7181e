"""The static page and the manual on a web host, below a path: no link begins at the host's root."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest
from fakes.site import ROOT, site
from fakes.site_server import serving_site
from fakes.static_page import shown

if TYPE_CHECKING:
    from pathlib import Path

    from fakes.browser import Browser

ABSOLUTE = re.compile(
    r"""(?:\b(?:href|src|action|poster)=|\bfrom |\bimport\(|\bfetch\(|\burl\()\s*["'`]?/(?!/)[^\s"'`)]*"""
)


def absolute_links(folder: Path) -> list[str]:
    kinds = {".html", ".css", ".js"}
    files = [path for path in sorted(folder.rglob("*")) if path.suffix in kinds]
    assert files
    texts = ((path, path.read_text(encoding="utf-8")) for path in files)
    return [f"{path.name}: {found[0]}" for path, text in texts for found in ABSOLUTE.finditer(text)]


def test_what_counts_as_an_absolute_link(tmp_path: Path) -> None:
    (tmp_path / "page.html").write_text('<a href="/top"><img src="a/b.png"><a href="//host/"><a href="https://host/">')
    (tmp_path / "script.js").write_text('import x from "/x.js"; import y from "./y.js"; fetch("/z"); fetch(`/w`)')
    assert len(absolute_links(tmp_path)) == 4


@pytest.mark.parametrize("name", ["site", "docs"])
def test_no_link_is_absolute(name: str) -> None:
    folder = ROOT / "build" / name
    if not folder.exists():
        pytest.skip(f"build/{name} is not here: make {name}")
    assert absolute_links(folder) == []


def test_the_page_works_below_a_path(browser: Browser, paths: list[str]) -> None:
    """Workers, modules, examples, the circuit and the element are all found there."""
    site()
    browser.open("about:blank")
    browser.open(browser.address + "#scene=house&depth=5")
    assert browser.until("document.querySelector('#stage').dataset.scene === 'house 5'")
    browser.click("#run-hardware")
    assert browser.until("!document.querySelector('#hardware-result').hidden", 60)
    browser.run("fetch('voxrt-view.js').then((answer) => (window.element = answer.ok))")
    assert browser.until("window.element")
    assert all(path.startswith("/voxrt/try/") for path in paths if path != "/favicon.ico")
    assert not any(path.endswith("undefined") for path in paths)


def test_the_page_opens_without_a_network_after_its_first_visit(browser: Browser) -> None:
    with serving_site() as address:
        browser.open(address)
        assert browser.until(shown("courtyard", 7))
        browser.run("navigator.serviceWorker.ready.then(() => (window.kept = true))")
        assert browser.until("window.kept")
    browser.open("about:blank")
    browser.open(f"{address}#scene=house&depth=5")  # whose files and reader were not loaded before
    assert browser.until(shown("house", 5))
    assert all("ERR_CONNECTION_REFUSED" in fault for fault in browser.faults())
