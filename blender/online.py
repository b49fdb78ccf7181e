"""Blender's preference of who may use the internet."""

from __future__ import annotations

import ipaddress
from urllib.parse import urlsplit

import bpy

import voxrt


def check_online(address: str) -> None:
    """Raise SimulatorError for an address in the internet, where Blender must stay offline."""
    host = urlsplit(address).hostname
    if bpy.app.online_access or host is None or _is_local(host):
        return
    raise voxrt.SimulatorError(
        f"{address}: Blender may not use the internet; allow online access in Preferences > System"
    )


def _is_local(host: str) -> bool:
    """Tell whether a host is this machine, or one of the network around it."""
    try:
        return not ipaddress.ip_address(host).is_global
    except ValueError:
        return "." not in host or host.endswith(".local")
