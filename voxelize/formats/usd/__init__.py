"""OpenUSD stages (usda, usdc, usdz), read through usd-core, which runs in a process of its own."""

from voxrt.voxelize.formats.usd.isolated import read_isolated
from voxrt.voxelize.formats.usd.limits import Limits

__all__ = ["Limits", "read_isolated"]
