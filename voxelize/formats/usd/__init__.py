"""OpenUSD stages (usda, usdc, usdz), read through usd-core."""

from voxrt.voxelize.formats.usd.load import load_usd

__all__ = ["load_usd"]
