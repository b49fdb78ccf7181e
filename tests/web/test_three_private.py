"""The private members of three.js that the page replaces, calls and reads: all are named, and three.js has them."""

from __future__ import annotations

import re

import pytest
from fakes.site import ROOT

USD = ROOT / "web" / "page" / "usd"
PRIVATE = (USD / "three_private.js").read_text()
THREE = ROOT / "web" / "node_modules" / "three"
CLASSES = ("USDComposer", "USDAParser", "USDCParser")


def named(kind: str, name: str) -> set[str]:
    """The members of a kind (replaced, called, read) that three_private.js names for a class."""
    part = PRIVATE[PRIVATE.index(f"  {name}: {{") :].split("\n  }", 1)[0].split(" },\n", 1)[0]
    lists = re.search(rf"{kind}: (\[.*?\]|named\(\"[^\"]*\"\))", part, re.DOTALL)
    return set(re.sub(r"[^\w]|named", " ", lists[1]).split()) if lists else set()


@pytest.mark.parametrize("name", CLASSES)
def test_three_has_the_members(name: str) -> None:
    file = THREE / "examples" / "jsm" / "loaders" / "usd" / f"{name}.js"
    if not file.exists():
        pytest.skip("three.js is not here: npm ci --prefix web")
    text = file.read_text()
    assert named("replaced", name)
    assert named("replaced", name) | named("called", name) <= set(re.findall(r"^\t(\w+)\(.*\{$", text, re.MULTILINE))
    assert named("read", name) <= set(re.findall(r"this\.(\w+) =", text))


def test_every_private_member_in_use_is_named() -> None:
    known = set().union(*(named(kind, name) for kind in ("replaced", "called", "read") for name in CLASSES))
    for file in USD.glob("*.js"):
        used = set(re.findall(r"(?:\.|^    ?|^  )(_[a-z]\w+)\b", file.read_text(), re.MULTILINE))
        assert used <= known, file.name


def test_the_members_were_checked_with_the_release_in_use() -> None:
    (checked,) = re.findall(r'CHECKED_RELEASE = "(\d+)"', PRIVATE)
    lock = (ROOT / "web" / "package-lock.json").read_text()
    assert re.search(rf'"node_modules/three": {{\s*"version": "0\.{checked}\.', lock)
