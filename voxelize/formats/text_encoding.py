"""Text in the encodings of Unicode, as bytes that ASCII readers take."""

from __future__ import annotations

import codecs
from typing import TYPE_CHECKING

from voxrt.voxelize.errors import AssetError

if TYPE_CHECKING:
    from pathlib import Path

_BOMS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF32_LE, "utf-32-le"),  # before UTF-16, whose mark it begins with
    (codecs.BOM_UTF32_BE, "utf-32-be"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)


def is_marked_wide(data: bytes) -> bool:
    """Tell whether bytes begin with the mark of UTF-16 or UTF-32."""
    return data.startswith(tuple(mark for mark, name in _BOMS if name != "utf-8"))


def ascii_compatible(path: Path, data: bytes) -> bytes:
    """Return text as UTF-8, or as it is where nothing says that it is UTF-16 or UTF-32."""
    encoding = next((name for mark, name in _BOMS if data.startswith(mark)), None)
    if encoding is None and len(data) >= 4 and 0 in data[:4]:
        # No mark, but one byte in two is zero: UTF-16 of ASCII text.
        encoding = "utf-16-be" if data[0] == 0 and data[1] else "utf-16-le" if data[1] == 0 and data[0] else None
    if encoding is None or encoding == "utf-8":
        return data.removeprefix(codecs.BOM_UTF8)
    try:
        return data.decode(encoding).lstrip("\ufeff").encode("utf-8")
    except UnicodeDecodeError:
        raise AssetError(
            path, f"is not the {encoding.upper()} text that it begins as", fix="save it as UTF-8"
        ) from None
