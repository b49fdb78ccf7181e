"""The options of a frame server."""

from __future__ import annotations

from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Limits:
    """The load that a server accepts.

    Attributes
    ----------
    clients
        Clients at the same time.
    connections
        Connections at the same time, those without a complete handshake included.
    new_clients_per_second
        On average; a burst may have twice as many.
    requests_per_second
        Messages per second and client, on average; a burst may have twice as many. Further messages wait.
    handshake_seconds
        Time limit of a handshake.
    """

    clients: int = 64
    connections: int = 256
    new_clients_per_second: float = 50
    requests_per_second: float = 400
    handshake_seconds: float = 5


@dataclass(frozen=True, slots=True)
class ServerOptions:
    """Where a server listens, and who may connect.

    Attributes
    ----------
    host, port
        Address and TCP port; port 0 takes a free one.
    token
        The token that every client must send; required on every address that is not loopback.
    origins
        Origins besides the server's own whose pages may connect.
    legacy_port
        TCP port of the legacy protocol; None switches it off.
    limits
        The load that the server accepts.
    """

    host: str = "127.0.0.1"
    port: int = 0
    token: str | None = None
    origins: tuple[str, ...] = ()
    legacy_port: int | None = None
    limits: Limits = field(default_factory=Limits)
