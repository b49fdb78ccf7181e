"""Limits on those who have not shown a token yet, per address."""

from __future__ import annotations

import collections
import ipaddress
import time
from typing import TYPE_CHECKING

from voxrt.serve.rate_limiter import RateLimiter

if TYPE_CHECKING:
    from voxrt.serve.server_options import Limits

_ADDRESSES = 4096
_IPV6_BITS = 64  # of an address that one customer has


class Strangers:
    """Counts connections by address, as long as they have no token.

    Parameters
    ----------
    limits
        How many connections an address may open per second, and have without a token.
    """

    def __init__(self, limits: Limits) -> None:
        self._limits = limits
        self._open: collections.Counter[str] = collections.Counter()
        self._limiters: dict[str, RateLimiter] = {}

    def admit(self, address: str) -> bool:
        """Tell whether `address`, as :func:`network` gives it, may open a connection; if so, count it."""
        limiter = self._limiters.get(address)
        if limiter is None:
            self._forget_rested()
            limiter = self._limiters[address] = RateLimiter(
                self._limits.new_connections_per_address_and_second, time.monotonic
            )
        if self._open[address] >= self._limits.strangers_per_address or not limiter.acquire():
            return False
        self._open[address] += 1
        return True

    def leave(self, address: str) -> None:
        """Count a connection no more: it was closed, or has shown the token."""
        self._open[address] -= 1
        if self._open[address] <= 0:
            del self._open[address]

    def _forget_rested(self) -> None:
        if len(self._limiters) >= _ADDRESSES:
            kept = {address: limiter for address, limiter in self._limiters.items() if not limiter.rested}
            self._limiters = kept if len(kept) < _ADDRESSES else {}


def network(peer: object) -> str:
    """Return the address to which limits apply, of a socket's peer: of IPv6 its first 64 bits.

    Examples
    --------
    >>> network(("::ffff:10.0.0.7", 51234, 0, 0)), network(("2001:db8::1:2", 51234, 0, 0))
    ('10.0.0.7', '2001:db8::/64')
    """
    try:
        address = ipaddress.ip_address(str(peer[0]).partition("%")[0])  # type: ignore[index]
    except (TypeError, IndexError, ValueError):
        return ""
    if isinstance(address, ipaddress.IPv4Address):
        return str(address)
    if address.ipv4_mapped is not None:
        return str(address.ipv4_mapped)
    return str(ipaddress.ip_network((address, _IPV6_BITS), strict=False))
