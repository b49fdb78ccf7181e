"""MeshLib from file to file: ``python bench/peer_meshlib.py FILE SIDE OUT.vdb``, for peer_files.py."""

import sys

from meshlib import mrmeshpy

file, side, out = sys.argv[1:]
loaded = mrmeshpy.loadSceneFromAnySupportedFormat(file).obj
mesh = mrmeshpy.mergeMeshes([item.meshPtr() for item in mrmeshpy.getAllObjectsInTree_ObjectMesh(loaded)])
size = mesh.computeBoundingBox().size()
params = mrmeshpy.MeshToVolumeParams()
params.type = mrmeshpy.MeshToVolumeParams.Type.Signed
params.voxelSize = mrmeshpy.Vector3f.diagonal(max(size.x, size.y, size.z) / int(side))
mrmeshpy.saveVoxels(mrmeshpy.meshToVolume(mrmeshpy.MeshPart(mesh), params), out)
