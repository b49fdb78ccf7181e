"""Text of strangers that people are shown."""

from __future__ import annotations

_LIMIT = 1000


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
