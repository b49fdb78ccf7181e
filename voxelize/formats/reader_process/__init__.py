"""Reading files in processes of their own, within limits on memory, time and the files that they open."""
