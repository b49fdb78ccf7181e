"""The acid test of voxelizers: an exact checker, cases, and what each tool promises; ``bench/acid.py`` runs it."""
