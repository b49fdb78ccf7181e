"""What a build starts from: files, arrays, meshes of trimesh, scenes."""
