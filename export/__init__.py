"""Rom to files and back."""
