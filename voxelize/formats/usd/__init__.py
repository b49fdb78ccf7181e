"""OpenUSD stages (usda, usdc, usdz), read through usd-core, which runs in a process of its own (``isolated.py``)."""
