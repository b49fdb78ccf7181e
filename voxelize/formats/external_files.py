"""Assets, and the files that they refer to: those in their folder and below; others only where the user allows it."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from voxrt.voxelize.errors import AssetError

if TYPE_CHECKING:
    from voxrt.voxelize.warning_log import WarningLog

ALLOW_OUTSIDE = "put it into the asset's folder, or allow it: --allow-outside (in Python: allow_outside=True)"
"""How to fix a reference to a file outside the asset's folder."""


LFS_POINTER = b"version https://git-lfs.github.com/spec/"
"""How the small files begin that Git LFS puts in the place of large ones."""


def asset_name(path: Path) -> str:
    """Return what a scene is called that is read from a file."""
    return as_text(path.stem)


def as_text(name: str) -> str:
    r"""Return a name as text that can name files: what is no text, or a backslash, becomes ``_``.

    Examples
    --------
    >>> as_text("back\\slash")
    'back_slash'
    """
    text = os.fsencode(name).decode("utf-8", "replace")
    return text.translate({0xFFFD: "_", ord("\\"): "_"})


def read_asset(path: Path) -> bytes:
    """Read a file whole; raise AssetError where it cannot be read."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise AssetError(path, f"cannot be read: {error.strerror}", fix="check the path and its permissions") from None
    refuse_pointer(path, data)
    return data


def refuse_pointer(path: object, data: bytes, place: str = "") -> None:
    """Raise AssetError where a file's bytes are those of a Git LFS pointer."""
    if data.startswith(LFS_POINTER):
        raise AssetError(path, "is a Git LFS pointer, which stands for the file", place=place, fix="run: git lfs pull")


@dataclass(frozen=True, slots=True)
class ExternalFiles:
    """The folders in which the files that an asset refers to may be."""

    folder: Path  # the asset's folder, with links resolved
    allow_outside: bool = False  # whether files outside that folder may be opened

    @classmethod
    def of(cls, asset: Path, *, allow_outside: bool) -> ExternalFiles:
        """Return the external files of the file `asset`."""
        return cls(asset.parent.resolve(), allow_outside)

    def allows(self, target: Path) -> bool:
        """Tell whether the file `target`, with links resolved, may be opened."""
        return self.allow_outside or target.is_relative_to(self.folder)

    def find(self, *names: str) -> Path | None:
        """Return the first existing file of `names`, relative to the folder, allowed or not; None where none exists."""
        for name in names:
            try:
                target = (self.folder / name).resolve()
                if target.is_file():
                    return target
            except (OSError, ValueError, RuntimeError):  # too long, a NUL, a loop of links
                continue
        return None

    def reported(
        self, found: Path | None, kind: str, name: str, log: WarningLog, *, count: int = 1, instead: str = ""
    ) -> Path | None:
        """Return the file that :meth:`find_exported` found; None, with a warning, where it may not be opened.

        `kind` says what `name` is: a texture, a material library. `instead` says what replaces it.
        """
        if found is None:
            log.add(f"missing-{kind.rsplit(maxsplit=1)[-1]}", f"{kind} {name!r} was not found{instead}", count)
        elif not self.allows(found):
            problem = f"{kind} {name!r} is outside the file's folder and was not opened"
            log.add("outside", f"{problem}; {ALLOW_OUTSIDE}", count)
            found = None
        return found

    def find_exported(self, name: str, start: Path | None = None) -> Path | None:
        """Return the file that another machine's path means; None where there is none.

        Backslashes separate folders, too. The last part alone is tried as well, and case does not matter. An allowed
        file is preferred to others. Names are relative to the folder `start`, or to the asset's folder for None.
        """
        parts = PurePosixPath(name.strip().strip('"').replace("\\", "/")).parts
        found = [self._ignoring_case(tail, start or self.folder) for tail in (parts, parts[-1:]) if tail]
        there = [target for target in found if target is not None]
        return next((target for target in there if self.allows(target)), next(iter(there), None))

    def _ignoring_case(self, parts: tuple[str, ...], start: Path) -> Path | None:
        place = start
        try:
            for part in parts:
                here = place / part
                if part != ".." and not here.exists() and place.is_relative_to(self.folder) and place.is_dir():
                    here = next((one for one in sorted(place.iterdir()) if one.name.lower() == part.lower()), here)
                place = here
        except (OSError, ValueError, RuntimeError):
            return None
        return self.find(str(place))
