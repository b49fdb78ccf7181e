"""The octree and its words: build, share, validate, query."""

from pkgutil import extend_path

__path__ = extend_path(__path__, __name__)

from voxrt.octree.animation import (
    Animation,
    AnimationFrame,
    check_frame_count,
    check_roots,
    frame_octree,
    frames_as_octants,
    join_frames,
)
from voxrt.octree.budget import BOARDS, Fit, coarsen, fit, share
from voxrt.octree.construct import build, from_dense, from_points
from voxrt.octree.decoding import decode
from voxrt.octree.dialects import DIALECTS, Dialect, detect_dialect, encode
from voxrt.octree.difference import Difference, Region, diff, differing_regions
from voxrt.octree.errors import RomError
from voxrt.octree.hidden import fill_hidden, hidden_voxels, share_hidden
from voxrt.octree.leaf_arrays import Leaves, leaves
from voxrt.octree.octant import Octant, octant_at
from voxrt.octree.octree import MAX_DEPTH, Octree
from voxrt.octree.owners import Owners
from voxrt.octree.query import count_in_box, material_at, solid_bounds
from voxrt.octree.rom import Rom
from voxrt.octree.statistics import Census, census
from voxrt.octree.surface import SurfaceChange, surface_change
from voxrt.octree.vdb import from_vdb
from voxrt.octree.voxel_arrays import ARRAY_LIMIT, to_dense, to_points

__all__ = [
    "ARRAY_LIMIT",
    "BOARDS",
    "DIALECTS",
    "MAX_DEPTH",
    "Animation",
    "AnimationFrame",
    "Census",
    "Dialect",
    "Difference",
    "Fit",
    "Leaves",
    "Octant",
    "Octree",
    "Owners",
    "Region",
    "Rom",
    "RomError",
    "SurfaceChange",
    "build",
    "census",
    "check_frame_count",
    "check_roots",
    "coarsen",
    "count_in_box",
    "decode",
    "detect_dialect",
    "diff",
    "differing_regions",
    "encode",
    "fill_hidden",
    "fit",
    "frame_octree",
    "frames_as_octants",
    "from_dense",
    "from_points",
    "from_vdb",
    "hidden_voxels",
    "join_frames",
    "leaves",
    "material_at",
    "octant_at",
    "share",
    "share_hidden",
    "solid_bounds",
    "surface_change",
    "to_dense",
    "to_points",
]
