"""Errors of the public interface."""


class ToolError(Exception):
    """An external tool is missing or has failed; in one line."""
