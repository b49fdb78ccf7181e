"""What is wrong with a command line."""


class UsageError(Exception):
    """A command line that cannot be understood, in one line."""
