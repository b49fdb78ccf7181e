"""The options of a frame server."""

from __future__ import annotations

from msgspec import field

from voxrt.voxelize.value import Value


class Limits(Value, frozen=True):
    """The load that a server accepts.

    Attributes
    ----------
    clients
        Clients at the same time.
    connections
        Connections at the same time, those without a complete handshake included.
    new_clients_per_second
        On average; a burst may have twice as many.
    strangers_per_address
        Connections of one address at the same time that have not shown the token.
    new_connections_per_address_and_second
        On average; a burst may have twice as many. Each load of the page makes about 40, one per file.
    frames_per_second, bytes_per_second
        What is read of a connection, on average; a burst may have twice as many. The rest waits. Frames are those of
        WebSocket: messages, their fragments, pings and pongs.
    text_bytes_per_second
        What is read of a connection's text messages, on average; a burst may have twice as many. The rest waits.
    fragments
        Fragments of a message.
    edits_per_second
        Edits of the scene, on average; a burst may have twice as many. Further ones are refused.
    handshake_seconds
        Time limit of a handshake.
    send_seconds, send_bytes_per_second
        Time limit of sending a message, and its speed beyond: a client that is slower is dropped.
    frame_bytes
        Frames that are kept, since they are being sent to clients, together. Beyond, the client that has taken longest
        is dropped.
    """

    clients: int = 64
    connections: int = 256
    new_clients_per_second: float = 20
    strangers_per_address: int = 64
    new_connections_per_address_and_second: float = 200
    frames_per_second: float = 400
    bytes_per_second: float = 1 << 24
    text_bytes_per_second: float = 1 << 17
    fragments: int = 64
    edits_per_second: float = 40
    handshake_seconds: float = 5
    send_seconds: float = 20
    send_bytes_per_second: float = 1 << 20
    frame_bytes: int = 1 << 28


class ServerOptions(Value, frozen=True):
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
