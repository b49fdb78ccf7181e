"""The elements of XML files, one after another, by lxml."""

from __future__ import annotations

import io
from importlib import import_module
from typing import TYPE_CHECKING, Any

from voxrt.voxelize.errors import DAMAGED, AssetError

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

_DISTRIBUTIONS = {"collada": "pycollada"}  # of modules, where the name is another


def need(path: Path, *modules: str) -> None:
    """Raise AssetError where a module that a file takes is not installed."""
    for module in modules:
        try:
            import_module(module)
        except ImportError:
            fix = f"pip install {_DISTRIBUTIONS.get(module, module)}"
            raise AssetError(path, f"takes {module}, which is not installed", fix=fix) from None


def xml_elements(path: Path, text: bytes, *tags: str, event: str = "end", place: str = "") -> Iterator[Any]:
    """Go through the elements of `text` with some tags, of any namespace, as they end.

    Entities are not resolved, and nothing else is opened. AssetError where it is no XML: `path` is the file,
    `place` the part of it.
    """
    etree = import_module("lxml.etree")
    wanted = [f"{{*}}{tag}" for tag in tags]
    try:
        for _, element in etree.iterparse(
            io.BytesIO(text), events=(event,), tag=wanted, resolve_entities=False, no_network=True
        ):
            yield element
    except etree.XMLSyntaxError as error:
        problem = f"its XML is broken ({' '.join(str(error.msg).split())})"
        raise AssetError(path, problem, place=place, fix=DAMAGED) from None
