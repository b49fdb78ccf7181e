"""From a source to a memory and its files: the pipeline, and what it makes."""
