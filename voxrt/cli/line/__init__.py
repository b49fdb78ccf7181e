"""A command line and what the tables of options make of it: its values, the help, the completion."""
