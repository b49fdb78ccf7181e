"""The commands as a user runs them."""

from fakes.commands import built, folder, process, voxrt  # noqa: F401
