"""Error messages about JSON that does not match the schema."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import msgspec


def explain(error: msgspec.ValidationError, place: str = "") -> tuple[str, str]:
    """Return what is wrong, and the JSON path of it: that of `error` below `place`."""
    problem, _, where = str(error).partition(" - at ")
    path = place + where.strip("`").removeprefix("$")
    return problem[:1].lower() + problem[1:], path.removeprefix(".")
