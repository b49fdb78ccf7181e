"""The addresses and names of this machine, by which browsers on others reach it."""

from __future__ import annotations

import contextlib
import ipaddress
import socket
import struct
import sys

from voxrt.serve.access_control import is_loopback

_SIOCGIFADDR = 0x8915  # Linux: the IPv4 address of a network interface
_ELSEWHERE = ((socket.AF_INET, "192.0.2.1"), (socket.AF_INET6, "2001:db8::1"))  # for documentation: nobody has them


def reachable_hosts(host: str) -> tuple[str, ...]:
    """Return what can stand in the address of a page that is served on `host`, the best for other machines first.

    Parameters
    ----------
    host
        A name or an address. ``0.0.0.0`` and ``::`` stand for all addresses of this machine.

    Examples
    --------
    >>> reachable_hosts("10.0.0.7")
    ('10.0.0.7',)
    """
    if not is_wildcard(host):
        return (host,)
    versions = (4,) if host != "::" else (4, 6)
    outward = [found for family, elsewhere in _ELSEWHERE if (found := _address_towards(family, elsewhere)) is not None]
    addresses = [found for found in dict.fromkeys([*outward, *_interface_addresses()]) if _is_useful(found, versions)]
    return (*addresses, *host_names(), "127.0.0.1")


def accepted_hosts(host: str) -> tuple[str, ...]:
    """Return the hosts whose pages may connect to a server on `host`; connections on loopback have rules of their own.

    Besides :func:`reachable_hosts` there is the name by which machines without a name server find each other.
    """
    bare = socket.gethostname().lower().partition(".")[0]
    local = (f"{bare}.local",) if is_wildcard(host) else ()
    return (*(found for found in reachable_hosts(host) if not is_loopback(found)), *local)


def host_names() -> tuple[str, ...]:
    """Return the names of this machine, as browsers spell them."""
    names = [socket.gethostname()]
    with contextlib.suppress(OSError):
        names.append(socket.getfqdn())
    found = [name.lower() for name in names if name and not name.startswith("localhost")]
    return tuple(name for name in dict.fromkeys(found) if name.isascii() and not name.endswith(".arpa"))


def is_wildcard(host: str) -> bool:
    """Tell whether `host` stands for all addresses of this machine."""
    try:
        return ipaddress.ip_address(host).is_unspecified
    except ValueError:
        return host == ""


def _is_useful(address: str, versions: tuple[int, ...]) -> bool:
    parsed = ipaddress.ip_address(address)
    return parsed.version in versions and not (parsed.is_loopback or parsed.is_link_local or parsed.is_unspecified)


def _address_towards(family: socket.AddressFamily, elsewhere: str) -> str | None:
    """Return this machine's address on the way to another one; nothing is sent."""
    try:
        with socket.socket(family, socket.SOCK_DGRAM) as probe:
            probe.connect((elsewhere, 9))
            return str(probe.getsockname()[0])
    except OSError:
        return None


def _interface_addresses() -> list[str]:
    """Return the addresses of the name of this machine, and on Linux the IPv4 addresses of all network interfaces."""
    found: list[str] = []
    with contextlib.suppress(OSError):
        found += [str(entry[4][0]) for entry in socket.getaddrinfo(socket.gethostname(), None, type=socket.SOCK_STREAM)]
    if sys.platform == "linux":
        import fcntl  # noqa: PLC0415 - Windows has none

        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            for _, name in socket.if_nameindex():
                with contextlib.suppress(OSError):  # an interface without an IPv4 address
                    answer = fcntl.ioctl(probe.fileno(), _SIOCGIFADDR, struct.pack("256s", name.encode()[:15]))
                    found.append(socket.inet_ntoa(answer[20:24]))
    return [address.partition("%")[0] for address in found]
