"""Assets, and the files that they refer to: those in their folder and below; others only where the user allows it."""

from __future__ import annotations

import os
from pathlib import Path, PurePosixPath
from stat import S_ISDIR, S_ISREG
from typing import TYPE_CHECKING

from msgspec import Struct

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
    refuse_endless(path)
    try:
        data = path.read_bytes()
    except OSError as error:
        raise AssetError(path, f"cannot be read: {error.strerror}", fix="check the path and its permissions") from None
    refuse_pointer(path, data)
    return data


def refuse_endless(path: Path) -> None:
    """Raise AssetError for a pipe or a device: what is read from it may never end."""
    try:
        mode = path.stat().st_mode
    except (OSError, ValueError):
        return  # opening says why
    if not (S_ISREG(mode) or S_ISDIR(mode)):
        raise AssetError(path, "is a pipe or a device", fix="save it to a file, and name that")


def refuse_pointer(path: object, data: bytes, place: str = "") -> None:
    """Raise AssetError where a file's bytes are those of a Git LFS pointer."""
    if data.startswith(LFS_POINTER):
        raise AssetError(path, "is a Git LFS pointer, which stands for the file", place=place, fix="run: git lfs pull")


class ExternalFiles(Struct, frozen=True):
    """The files that an asset refers to by name: those in its folder and below may be opened, and no others.

    Whether a name leads out of the folder is told from the name and the links in the folder alone: nobody learns which
    other files there are.
    """

    folder: Path  # the asset's folder, with links resolved
    written: Path  # the asset's folder as the caller wrote it, absolute
    allow_outside: bool = False  # whether files outside that folder may be opened

    @classmethod
    def of(cls, asset: Path, *, allow_outside: bool) -> ExternalFiles:
        """Return the external files of the file `asset`."""
        return cls(asset.parent.resolve(), Path(os.path.normpath(asset.parent.absolute())), allow_outside)

    def is_outside(self, *names: str) -> bool:
        """Tell whether one of `names` leads out of the folder, and that is not allowed. No file need be there."""
        return any(self._refuses(name) for name in names)

    def find(self, *names: str) -> Path | None:
        """Return the first existing file of `names`, relative to the folder, that may be opened; None without any."""
        for name in names:
            try:
                target = (self.folder / name).resolve()
                if not self._refuses(name) and target.is_file():
                    return target
            except (OSError, ValueError, RuntimeError):  # too long, a NUL, a loop of links
                continue
        return None

    def _refuses(self, name: str) -> bool:
        return not (self.allow_outside or self._is_below(self.folder / name))

    def _is_below(self, place: Path) -> bool:
        plain = Path(os.path.normpath(place))  # without a look at what is there
        if not (plain.is_relative_to(self.folder) or plain.is_relative_to(self.written)):
            return False
        try:
            return plain.resolve().is_relative_to(self.folder)
        except (OSError, ValueError, RuntimeError):
            return True  # nothing can be there

    def find_exported(self, name: str, start: Path | None = None) -> Path | None:
        """Return the file that another machine's path means, if it may be opened; None where there is none.

        Backslashes separate folders, too. The last part alone is tried as well, and case does not matter. Names are
        relative to the folder `start`, or to the asset's folder for None.
        """
        parts = _parts(name)
        found = (self._ignoring_case(tail, start or self.folder) for tail in (parts, parts[-1:]) if tail)
        return next((target for target in found if target is not None), None)

    def reported(
        self,
        found: Path | None,
        kind: str,
        name: str,
        log: WarningLog,
        *,
        start: Path | None = None,
        count: int = 1,
        instead: str = "",
    ) -> Path | None:
        """Return the file that :meth:`find_exported` found, or None with a warning.

        `kind` says what `name`, relative to `start`, is: a texture, a material library. `instead` says what replaces
        it.
        """
        if found is not None:
            return found
        if self.is_outside(str(Path(start or self.folder, *_parts(name)))):
            problem = f"{kind} {name!r} is outside the file's folder and was not opened"
            log.add("outside", f"{problem}; {ALLOW_OUTSIDE}", count)
        else:
            log.add(f"missing-{kind.rsplit(maxsplit=1)[-1]}", f"{kind} {name!r} was not found{instead}", count)
        return None

    def _ignoring_case(self, parts: tuple[str, ...], start: Path) -> Path | None:
        place = start
        try:
            for part in parts:
                here = place / part
                if part != ".." and self._is_below(place) and not here.exists() and place.is_dir():
                    here = next((one for one in sorted(place.iterdir()) if one.name.lower() == part.lower()), here)
                place = here
        except (OSError, ValueError, RuntimeError):
            return None
        return self.find(str(place))


def _parts(name: str) -> tuple[str, ...]:
    """Return the folders and the name of a path that another system may have written."""
    return PurePosixPath(name.strip().strip('"').replace("\\", "/")).parts
