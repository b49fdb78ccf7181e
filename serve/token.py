"""The token that clients must send."""

from __future__ import annotations

import secrets
from typing import TYPE_CHECKING

from voxrt.board.errors import Refused
from voxrt.serve.access_control import is_loopback

if TYPE_CHECKING:
    from pathlib import Path

_LIMIT = 200
_RANDOM_BYTES = 16


def choose_token(host: str, token: str | None, token_file: Path | None) -> str | None:
    """Return the token of a server: the given one, the one of the file, or a random one where one is needed.

    Parameters
    ----------
    host
        Where the server listens; None is returned on loopback only.
    token
        The token itself. Other users of the machine see the command line.
    token_file
        A file whose first line is the token.

    Raises
    ------
    Refused
        The token is empty or has characters that clients cannot send, both are given, or the file cannot be read.
    """
    if token_file is not None:
        if token is not None:
            raise Refused("--token and --token-file exclude each other; give one of them")
        try:
            with token_file.open(encoding="utf-8") as file:
                token = file.readline(_LIMIT + 2).strip()
        except (OSError, ValueError) as error:
            raise Refused(f"{token_file}: the token cannot be read ({error}); write it in the first line") from error
    if token is not None:
        check_token(token)
        return token
    return None if is_loopback(host) else secrets.token_urlsafe(_RANDOM_BYTES)


def check_token(token: str) -> None:
    """Refuse a token that is empty, or that clients cannot send.

    Raises
    ------
    Refused
        It says why.
    """
    if not 1 <= len(token) <= _LIMIT or not all("!" <= character <= "~" for character in token):
        raise Refused(
            f"the token has {len(token)} characters; it must have 1 to {_LIMIT}, printable ASCII without spaces"
        )
