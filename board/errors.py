"""What a board says when it cannot do what it was asked."""


class Refused(Exception):  # noqa: N818 - an answer, not a fault
    """A request that makes no sense or does not fit, in one line: what is wrong and what to do about it."""


class DeviceError(Exception):
    """The device did not do what it was told, in one line."""
