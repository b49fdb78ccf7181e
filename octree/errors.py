"""What octree says of a memory that is not one."""


class RomError(Exception):
    """A malformed octree memory, in one line: file or value, the word's address, what is wrong, how to fix it."""
