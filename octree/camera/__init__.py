"""What a picture of an octree needs besides its words: a camera and the lighting, in the grid frame."""

from voxrt.exports import exports_of

__getattr__, __dir__ = exports_of(__name__)
