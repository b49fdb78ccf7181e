"""The material table of a file that is being loaded: ids by order of first use."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.voxelize import _native
from voxrt.voxelize.errors import DoesNotFitError
from voxrt.voxelize.materials import DEFAULT_COLOUR, EMPTY, Material

if TYPE_CHECKING:
    from collections.abc import Hashable

    from voxrt.voxelize.warning_log import WarningLog

_DEFAULT_KEY = object()


class MaterialTable:
    """The materials of a scene under construction; entry 0 is empty space. `native` is the table itself."""

    def __init__(self) -> None:
        self.native = _native.MaterialTable(EMPTY.name, EMPTY.colour)
        self._ids: dict[Hashable, int] = {}

    def id_of(
        self, key: Hashable, name: str, colour: tuple[int, int, int], *, mirror: bool = False, authored: bool = True
    ) -> int:
        """Return the id of a material. Its first use adds it to the table.

        `key` identifies it in the file: a name, a prim path. A number is appended to the author's `name` where another
        material already has it. `authored` is False for a default that replaces a missing material. Raise
        DoesNotFitError for more than 255 materials.
        """
        if key in self._ids:
            return self._ids[key]
        try:
            self._ids[key] = self.native.add(name, colour, mirror, authored)
        except _native.TooManyMaterialsError as error:
            raise DoesNotFitError(str(error)) from None
        return self._ids[key]

    def default(self, log: WarningLog | None, faces: int = 1) -> int:
        """Return the id of the default material, and count `faces` faces that have none in `log`.

        None for a file that has no materials at all.
        """
        if log is not None:
            log.add("default-material", "faces without a material got the default one", faces)
        return self.id_of(_DEFAULT_KEY, "default", DEFAULT_COLOUR, authored=False)

    def __len__(self) -> int:
        return len(self.native.entries())

    def materials(self) -> tuple[Material, ...]:
        """Return the table so far, indexed by id."""
        return tuple(Material(*one) for one in self.native.entries())
