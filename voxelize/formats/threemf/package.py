"""The parts of a 3MF package, and their XML."""

from __future__ import annotations

import io
import zipfile
from typing import TYPE_CHECKING, Any

from msgspec import Struct

from voxrt.voxelize.errors import DAMAGED, AssetError
from voxrt.voxelize.formats.xml_elements import xml_elements

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

_FREE_BYTES, _MOST_TIMES = 1 << 26, 64
"""What the parts of a file may unpack to: so many bytes, and so many times its size more."""
_ROOT = "3d/3dmodel.model"
_RELATIONS = "_rels/.rels"
_SETTINGS = ("metadata/model_settings.config", "metadata/slic3r_pe_model.config")  # of Bambu Studio, of PrusaSlicer
_IS_ROOT = "/3dmodel"  # how the type of the relation to the root model ends


class Package(Struct, frozen=True):
    """The parts of a file by their names, as :func:`part_name` writes them; `root` is the one that is built."""

    path: Path
    archive: zipfile.ZipFile
    names: dict[str, str]
    root: str

    @classmethod
    def of(cls, path: Path, data: bytes) -> Package:
        """Open the package in a file's bytes; AssetError where it is none."""
        try:
            archive = zipfile.ZipFile(io.BytesIO(data))
            allowed = _FREE_BYTES + _MOST_TIMES * len(data)
            if sum(one.file_size for one in archive.infolist()) > allowed:
                problem = f"unpacks to more than {allowed >> 20} MiB, which is too much for its size"
                raise AssetError(path, problem, fix="it is made to do harm, or must be packed anew")
        except (zipfile.BadZipFile, OSError, NotImplementedError, RuntimeError, EOFError, ValueError) as error:
            raise _no_package(path, type(error).__name__) from None
        package = cls(path, archive, {part_name(name): name for name in archive.namelist()}, "")
        roots = [name for name in (package._related_root(), _ROOT) if name in package.names]
        roots += [name for name in package.names if name.endswith(_ROOT)]
        if not roots:
            raise _no_package(path, "without a model")
        return cls(path, archive, package.names, roots[0])

    def _related_root(self) -> str:
        if _RELATIONS not in self.names:
            return ""
        relations = self.elements(_RELATIONS, "Relationship")
        return next(
            (part_name(one.get("Target", "")) for one in relations if one.get("Type", "").endswith(_IS_ROOT)), ""
        )

    def assigns_filaments(self) -> bool:
        """Tell whether a slicer has written which filament prints which object."""
        return any(part in self.names and b"extruder" in self._text(part) for part in _SETTINGS)

    def elements(self, part: str, *tags: str, event: str = "end") -> Iterator[Any]:
        """Go through the elements of a part with some tags, of any namespace, as they end."""
        return xml_elements(self.path, self._text(part), *tags, event=event, place=part)

    def _text(self, part: str) -> bytes:
        try:
            return self.archive.read(self.names[part])
        except (zipfile.BadZipFile, OSError, NotImplementedError, RuntimeError, EOFError, ValueError) as error:
            raise _no_package(self.path, type(error).__name__) from None


def part_name(name: str) -> str:
    """Return the name of a part as one compares it: without the slash of the root, in small letters."""
    return name.strip("/").lower()


def _no_package(path: Path, problem: str) -> AssetError:
    return AssetError(path, f"is no 3MF package ({problem})", fix=DAMAGED)
