"""Errors of the front door."""


class ToolError(Exception):
    """An external tool is missing or has failed; in one line."""
