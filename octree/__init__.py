"""The octree and its words: build, share, validate, query."""

from voxrt.exports import exports_of

__getattr__, __dir__ = exports_of(__name__)
