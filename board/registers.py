"""Registers of the ray tracer: name, byte address, fields as (low, width). ``rtl/registers.rdl`` describes them."""

from voxrt.rtl.generated.voxrt_registers import MATERIALS, REGISTERS

__all__ = ["MATERIALS", "REGISTERS"]
