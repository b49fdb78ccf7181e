"""Text of strangers that people are shown."""

from __future__ import annotations

_LIMIT = 1000
_MOST_WARNINGS = 8


def shown_line(text: object, limit: int = _LIMIT) -> str:
    r"""Return one printable line of at most `limit` characters.

    Control characters, line ends, bidirectional controls and whatever else cannot be printed become escapes.

    Examples
    --------
    >>> shown_line("a\nb")
    'a\\x0ab'
    """
    line = "".join(
        character if character.isprintable() else f"\\x{ord(character):02x}" for character in str(text)[: limit + 1]
    )
    return line if len(line) <= limit else f"{line[: limit - 1]}…"


def shown_warnings(warnings: tuple[str, ...]) -> tuple[str, ...]:
    """Return the warnings of a scene as lines; of many the first, and one that counts the others.

    Examples
    --------
    >>> shown_warnings(tuple(f"texture {number} was not found" for number in range(20)))[-2:]
    ('texture 7 was not found', 'and 12 more; voxrt-build prints them')
    """
    if len(warnings) <= _MOST_WARNINGS + 1:
        return tuple(map(shown_line, warnings))
    rest = f"and {len(warnings) - _MOST_WARNINGS} more; voxrt-build prints them"
    return *map(shown_line, warnings[:_MOST_WARNINGS]), rest
