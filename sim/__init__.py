"""The verilated ray tracer and the exact model: cameras, rendering, comparison."""

from voxrt.exports import exports_of

__getattr__, __dir__ = exports_of(__name__)
