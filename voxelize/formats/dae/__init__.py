"""COLLADA: the geometries of a file by pycollada, where its nodes show them, and the materials bound to them."""
