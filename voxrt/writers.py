"""x"""

WRITABLE_SUFFIXES = ()


def convert(): ...
