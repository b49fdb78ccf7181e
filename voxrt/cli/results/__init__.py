"""What ``--json`` prints: the shape of each command's result."""
