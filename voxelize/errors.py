"""Errors and warnings about input."""

from __future__ import annotations

from voxrt.voxelize.value import Value

DAMAGED = "check the file in another program, and export it again"
"""How to mend a file that no program is likely to read."""


class AssetError(Exception):
    """An asset file that cannot be loaded. The message is one line: file, place in it, what is wrong, how to fix it.

    Parameters
    ----------
    path
        The file as the user named it.
    problem
        What is wrong, starting in lower case, without a full stop.
    place
        Where in the file: a JSON path, a prim path, a line number. Empty for the file as a whole.
    fix
        What the user can do about it.

    Examples
    --------
    >>> print(AssetError("house.obj", "a vertex needs three numbers", place="line 7", fix="repair the vertex"))
    house.obj: line 7: a vertex needs three numbers; repair the vertex
    """

    def __init__(self, path: object, problem: str, *, place: str = "", fix: str = "") -> None:
        self.path = str(path)
        self.place = place
        self.problem = problem
        self.fix = fix
        where = f"{self.path}: {place}" if place else self.path
        super().__init__(f"{where}: {problem}" + (f"; {fix}" if fix else ""))


class DoesNotFitError(Exception):
    """Valid input that exceeds a limit: too many materials, too many voxels per side, too many words."""


class SceneWarning(Value, frozen=True):
    """Something in the input that was ignored or replaced.

    Attributes
    ----------
    kind
        A stable kebab-case name, for programs: ``"default-material"``.
    message
        One line for people: what was done instead.
    count
        How many times it happened.

    Examples
    --------
    >>> print(SceneWarning("default-material", "faces without a material got the default one", 12))
    faces without a material got the default one (12 times)
    """

    kind: str
    message: str
    count: int = 1

    def __str__(self) -> str:
        return f"{self.message} ({self.count} times)" if self.count > 1 else self.message
