"""Errors of boards and of the frame server. Each message is one line."""


class Refused(Exception):  # noqa: N818 - the answer to a request, not a fault of the program
    """A request that is invalid or does not fit: what is wrong, and how to fix it."""


class DeviceError(Exception):
    """A failure of the device."""


class TooSlow(DeviceError):  # noqa: N818 - what happened to a frame, and no failure
    """A frame took longer than it may."""


class FrameDropped(Exception):  # noqa: N818 - nobody waits for the frame any more
    """A frame ended before its last pixel, since that was requested."""
