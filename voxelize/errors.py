"""What voxelize says to a person whose input it cannot honour."""

from __future__ import annotations

from dataclasses import dataclass


class AssetError(Exception):
    """An asset file that cannot be honoured, in one line: file, place in it, what is wrong, how to fix it.

    Parameters
    ----------
    path
        The file as the user named it.
    problem
        What is wrong, starting in lower case, without a full stop.
    place
        Where in the file: a JSON path, a prim path, a line number. Empty where the file as a whole is meant.
    fix
        What the user can do about it.
    """

    def __init__(self, path: object, problem: str, *, place: str = "", fix: str = "") -> None:
        self.path = str(path)
        self.place = place
        self.problem = problem
        self.fix = fix
        where = f"{self.path}: {place}" if place else self.path
        super().__init__(f"{where}: {problem}" + (f"; {fix}" if fix else ""))


class DoesNotFitError(Exception):
    """Input that is sound but larger than something holds: too many materials, too deep, too many words."""


@dataclass(frozen=True, slots=True)
class SceneWarning:
    """Something the input said that was not honoured as it stands, counted.

    Attributes
    ----------
    kind
        A stable kebab-case name, for programs: ``"default-material"``.
    message
        One line for people, saying what was done instead.
    count
        How many times it happened.
    """

    kind: str
    message: str
    count: int = 1
