"""Who may connect: tokens and origins."""

from __future__ import annotations

import hmac
import ipaddress
from urllib.parse import parse_qs, urlsplit

from voxrt.serve.shown_text import shown_line
from voxrt.voxelize.value import Value

_LOOPBACK_NAMES = ("localhost", "127.0.0.1", "::1")


class Refusal(Value, frozen=True):
    """The answer to a connection that is refused: HTTP status and a line of text."""

    status: int
    text: str


class AccessControl(Value, frozen=True):
    """Checks requests for a WebSocket.

    Attributes
    ----------
    token
        The token that every client must send; None accepts all clients, for loopback.
    origins
        Origins besides the server's own whose pages may connect.
    hosts
        Names and addresses of this machine, by which browsers reach it.
    """

    token: str | None
    origins: tuple[str, ...] = ()
    hosts: tuple[str, ...] = ()

    def check(
        self, target: str, authorization: str | None, origin: str | None, address: tuple[str, int]
    ) -> Refusal | None:
        """Return the refusal of a request; None where it is accepted.

        Parameters
        ----------
        target
            Path and query. The query of a page that asks why it was refused has its origin as well: a browser tells a
            page nothing of a refused WebSocket, and sends no origin with a GET to the page's own server.
        authorization, origin
            The headers with these names. Browsers always send an origin; other clients need not.
        address
            The address and port of the server to which the client connected.
        """
        query = parse_qs(urlsplit(target).query)
        origins = [*([] if origin is None else [origin]), *query.get("origin", [])]
        refused = [origin for origin in origins if not self._is_allowed(origin, address)]
        if refused:
            shown = shown_line(refused[0], 100)
            return Refusal(403, f"pages of {shown} may not connect; start the server with --origin {shown}\n")
        if self.token is not None and not self._has_token(query.get("token", [""])[0], authorization):
            return Refusal(
                401, "the token is missing or wrong: open the address that the server printed at its start\n"
            )
        return None

    def _has_token(self, token: str, authorization: str | None) -> bool:
        if authorization is not None and authorization.startswith("Bearer "):
            token = authorization[len("Bearer ") :]
        return hmac.compare_digest(token.encode("utf-8", "replace"), (self.token or "").encode())

    def _is_allowed(self, origin: str, address: tuple[str, int]) -> bool:
        # The Host header proves nothing: a page whose own name resolves to this address (DNS rebinding) sends its name
        # there too. So the origin must be the address itself, a name that this machine gives itself, or a loopback name
        # on a loopback connection.
        if origin in self.origins:
            return True
        try:
            parts = urlsplit(origin)
            host, port = parts.hostname, parts.port or 80
        except ValueError:
            return False
        if parts.scheme != "http" or host is None or port != address[1]:
            return False
        if host in self.hosts or is_loopback(address[0]):
            return host in (*self.hosts, *_LOOPBACK_NAMES)
        try:
            return ipaddress.ip_address(host) == _without_mapping(address[0])
        except ValueError:
            return False


def is_loopback(host: str) -> bool:
    """Tell whether `host`, a name or an address, can be reached from this machine only."""
    if host == "localhost":
        return True
    try:
        return _without_mapping(host).is_loopback
    except ValueError:
        return False


def _without_mapping(host: str) -> ipaddress.IPv4Address | ipaddress.IPv6Address:
    address = ipaddress.ip_address(host.split("%", maxsplit=1)[0])
    mapped = address.ipv4_mapped if isinstance(address, ipaddress.IPv6Address) else None
    return mapped or address
