"""The octree and its words: build, share, validate, query."""

from pkgutil import extend_path

__path__ = extend_path(__path__, __name__)

from voxrt.octree.errors import RomError
from voxrt.octree.octree import Octree
from voxrt.octree.rom import Rom

__all__ = ["Octree", "Rom", "RomError"]
