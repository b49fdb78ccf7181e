"""Reading the bytes of an asset file."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.voxelize.errors import AssetError

if TYPE_CHECKING:
    from pathlib import Path


def read_asset(path: Path) -> bytes:
    """Read a file whole; raise AssetError where it cannot be read."""
    try:
        return path.read_bytes()
    except OSError as error:
        raise AssetError(path, f"cannot be read: {error.strerror}", fix="check the path and its permissions") from None
