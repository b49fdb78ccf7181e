"""OpenUSD stages (usda, usdc, usdz), read through usd-core."""

from voxrt.voxelize.usd.load import load_usd

__all__ = ["load_usd"]
