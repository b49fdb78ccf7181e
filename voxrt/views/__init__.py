"""Cameras, pictures and the files that show a memory."""
