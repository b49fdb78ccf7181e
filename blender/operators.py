"""Operators."""


def register() -> None:
    """Register."""


def unregister() -> None:
    """Unregister."""
