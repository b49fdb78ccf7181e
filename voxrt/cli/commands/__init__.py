"""What each command does: a module per command, whose ``run`` takes the table of its options."""
