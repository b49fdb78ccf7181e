"""The commands as a user runs them."""

from fakes.commands import folder, voxrt  # noqa: F401
