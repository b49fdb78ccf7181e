"""Files that an asset names: looked for in its folder and below, elsewhere only when that is asked for."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path, PurePosixPath

ALLOW_OUTSIDE = "put it into the asset's folder, or allow it: --allow-outside, allow_outside=True"
"""The way out where an asset names a file outside its folder."""


@dataclass(frozen=True, slots=True)
class ExternalFiles:
    """Where the files that an asset names may stand.

    Attributes
    ----------
    folder
        The asset's folder, without links.
    allow_outside
        Whether they may stand elsewhere than there and below.
    """

    folder: Path
    allow_outside: bool = False

    @classmethod
    def of(cls, asset: Path, *, allow_outside: bool) -> ExternalFiles:
        """Return those of the file `asset`."""
        return cls(asset.parent.resolve(), allow_outside)

    def allows(self, target: Path) -> bool:
        """Tell whether the file `target`, without links, may be opened."""
        return self.allow_outside or target.is_relative_to(self.folder)

    def find(self, *names: str) -> Path | None:
        """Return the first file there is that one of `names` leads to from the folder, allowed or not; else None."""
        for name in names:
            try:
                target = (self.folder / name).resolve()
                if target.is_file():
                    return target
            except (OSError, ValueError, RuntimeError):  # too long, a NUL, a loop of links
                continue
        return None

    def find_exported(self, name: str) -> Path | None:
        """As :meth:`find`, for a path as another machine may have written it.

        Backslashes separate folders too, the path is tried by its last part as well, and the case of letters does not
        matter: that is how the exporting machine found it. A file that is allowed comes before one that is not.
        """
        parts = PurePosixPath(name.strip().strip('"').replace("\\", "/")).parts
        found = [self._whatever_its_case(tail) for tail in (parts, parts[-1:]) if tail]
        there = [target for target in found if target is not None]
        return next((target for target in there if self.allows(target)), next(iter(there), None))

    def _whatever_its_case(self, parts: tuple[str, ...]) -> Path | None:
        place = self.folder
        try:
            for part in parts:
                here = place / part
                if part != ".." and not here.exists() and place.is_relative_to(self.folder) and place.is_dir():
                    here = next((one for one in sorted(place.iterdir()) if one.name.lower() == part.lower()), here)
                place = here
        except (OSError, ValueError, RuntimeError):
            return None
        return self.find(str(place))
