"""The commands as a user runs them."""

from fakes.commands import folder, process, voxrt  # noqa: F401
