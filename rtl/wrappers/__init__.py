"""The core as a component of Amaranth."""
