"""STEP files: their solids as triangles, by OpenCASCADE."""
