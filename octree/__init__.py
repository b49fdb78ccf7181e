"""The octree and its words: build, share, validate, query."""

from pkgutil import extend_path

__path__ = extend_path(__path__, __name__)

from voxrt.octree.budget import BOARDS, Fit, coarsen, fit, share
from voxrt.octree.build import build, from_dense, from_points
from voxrt.octree.census import Census, census
from voxrt.octree.decode import decode
from voxrt.octree.dialects import DIALECTS, Dialect, detect_dialect, encode
from voxrt.octree.diff import Difference, Region, diff, differing_regions
from voxrt.octree.errors import RomError, ViewerError
from voxrt.octree.hidden import fill_hidden, hidden_voxels, share_hidden
from voxrt.octree.leaves import Leaves, leaves
from voxrt.octree.octant import Octant, octant_at
from voxrt.octree.octants import octants, open_sides
from voxrt.octree.octree import MAX_DEPTH, Octree
from voxrt.octree.owners import Owners
from voxrt.octree.pane import DrawnRay, Pane, Preview
from voxrt.octree.query import count_in_box, material_at, solid_bounds, to_dense
from voxrt.octree.rom import Rom
from voxrt.octree.surface import SurfaceChange, surface_change
from voxrt.octree.vdb import from_vdb
from voxrt.octree.view import picture, plot, turntable
from voxrt.octree.vox import read_vox
from voxrt.octree.window import Window

__all__ = [
    "BOARDS",
    "DIALECTS",
    "MAX_DEPTH",
    "Census",
    "Dialect",
    "Difference",
    "DrawnRay",
    "Fit",
    "Leaves",
    "Octant",
    "Octree",
    "Owners",
    "Pane",
    "Preview",
    "Region",
    "Rom",
    "RomError",
    "SurfaceChange",
    "ViewerError",
    "Window",
    "build",
    "census",
    "coarsen",
    "count_in_box",
    "decode",
    "detect_dialect",
    "diff",
    "differing_regions",
    "encode",
    "fill_hidden",
    "fit",
    "from_dense",
    "from_points",
    "from_vdb",
    "hidden_voxels",
    "leaves",
    "material_at",
    "octant_at",
    "octants",
    "open_sides",
    "picture",
    "plot",
    "read_vox",
    "share",
    "share_hidden",
    "show",
    "solid_bounds",
    "surface_change",
    "to_dense",
    "turntable",
]
