"""voxrt: meshes to voxels to an octree memory to pictures ray-traced by hardware."""

from pkgutil import extend_path

# A checkout's Python and an installed wheel's extension modules make one package.
__path__ = extend_path(__path__, __name__)

__version__ = "0.1.0"
