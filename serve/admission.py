"""Who may connect: token, origin, numbers and rates."""

from __future__ import annotations

import hmac
import ipaddress
from dataclasses import dataclass
from typing import TYPE_CHECKING
from urllib.parse import parse_qs, urlsplit

if TYPE_CHECKING:
    from collections.abc import Callable

_LOOPBACK_NAMES = ("localhost", "127.0.0.1", "::1")


@dataclass(frozen=True, slots=True)
class Limits:
    """What a server bears.

    Attributes
    ----------
    viewers
        Viewers at a time.
    sockets
        Connections of any kind at a time, unfinished ones too.
    arrivals
        New viewers a second, on average; twice as many at once.
    requests
        Messages a second that one viewer is heard, on average; twice as many at once. More wait.
    patience
        Seconds that a client may take to say what it wants.
    """

    viewers: int = 64
    sockets: int = 256
    arrivals: float = 50
    requests: float = 400
    patience: float = 5


class Bucket:
    """Lets `rate` things a second through on average, and twice as many at once.

    Parameters
    ----------
    rate
        Things a second.
    clock
        Monotonic seconds.
    """

    def __init__(self, rate: float, clock: Callable[[], float]) -> None:
        self._rate = rate
        self._clock = clock
        self._left = 2 * rate
        self._filled = clock()

    def take(self) -> float:
        """Take one thing: 0 where it may pass now, else the seconds until it may. Waiting is up to the caller."""
        now = self._clock()
        self._left = min(2 * self._rate, self._left + (now - self._filled) * self._rate)
        self._filled = now
        if self._left < 1:
            return (1 - self._left) / self._rate
        self._left -= 1
        return 0.0


@dataclass(frozen=True, slots=True)
class Refusal:
    """An answer to a connection that is not let in: HTTP status and a line of text."""

    status: int
    text: str


@dataclass(frozen=True, slots=True)
class Gate:
    """Judges requests for a WebSocket.

    Attributes
    ----------
    token
        What a viewer must know; None lets everybody in, for loopback.
    origins
        Origins of pages besides the server's own that may connect.
    """

    token: str | None
    origins: tuple[str, ...] = ()

    def judge(
        self, target: str, authorization: str | None, origin: str | None, address: tuple[str, int]
    ) -> Refusal | None:
        """Tell why a request is refused; None where it is let in.

        Parameters
        ----------
        target
            Path and query.
        authorization, origin
            The headers of these names; browsers always send an origin, others need not.
        address
            The server's address and port that the client reached.
        """
        if origin is not None and not self._is_ours(origin, address):
            return Refusal(403, f"pages of {origin[:100]} may not connect; name that origin when the server starts\n")
        if self.token is not None and not self._knows_token(target, authorization):
            return Refusal(401, "this server wants its token: open the address that it printed when it started\n")
        return None

    def _knows_token(self, target: str, authorization: str | None) -> bool:
        said = parse_qs(urlsplit(target).query).get("token", [""])[0]
        if authorization is not None and authorization.startswith("Bearer "):
            said = authorization[len("Bearer ") :]
        return hmac.compare_digest(said.encode(), (self.token or "").encode())

    def _is_ours(self, origin: str, address: tuple[str, int]) -> bool:
        # The Host header proves nothing: a page that has its own name resolve to this address (DNS rebinding) sends
        # its name there too. So the origin must be the address itself, or a loopback name reached over loopback.
        if origin in self.origins:
            return True
        try:
            parts = urlsplit(origin)
            host, port = parts.hostname, parts.port or 80
        except ValueError:
            return False
        if parts.scheme != "http" or host is None or port != address[1]:
            return False
        if is_loopback(address[0]):
            return host in _LOOPBACK_NAMES
        try:
            return ipaddress.ip_address(host) == _plain(address[0])
        except ValueError:
            return False


def is_loopback(host: str) -> bool:
    """Tell whether `host`, a name or an address, is this machine and nobody else."""
    if host == "localhost":
        return True
    try:
        return _plain(host).is_loopback
    except ValueError:
        return False


def _plain(host: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address:
    address = ipaddress.ip_address(host.split("%", maxsplit=1)[0])
    mapped = address.ipv4_mapped if isinstance(address, ipaddress.IPv6Address) else None
    return mapped or address
