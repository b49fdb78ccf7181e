"""The options of commands and of the Python API."""
