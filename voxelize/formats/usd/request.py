"""What the process that reads a USD file is asked."""

from __future__ import annotations

from voxrt.voxelize.formats.reader_process.limits import Request


class UsdRequest(Request, frozen=True, kw_only=True):
    """The options and limits of ``read_isolated``, and the process id of its caller."""

    variants: tuple[str, ...]
