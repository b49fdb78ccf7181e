"""3MF: the parts of a package, the objects of each, and the scene that they are built to."""
