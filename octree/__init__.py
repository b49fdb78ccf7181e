"""The octree and its words: build, share, validate, query."""

from importlib import import_module
from pkgutil import extend_path
from typing import TYPE_CHECKING

__path__ = extend_path(__path__, __name__)

__all__ = [
    "ARRAY_LIMIT",
    "BOARDS",
    "DIALECTS",
    "MAX_DEPTH",
    "Animation",
    "AnimationFrame",
    "Assembly",
    "Census",
    "Dialect",
    "Difference",
    "DiskAssembly",
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
    "shared_words",
    "solid_bounds",
    "surface_change",
    "to_dense",
    "to_points",
    "with_means",
]

# Imported when first used: a build waits for what it needs alone.
_HOMES = {
    "voxrt.octree.animation": (
        "Animation",
        "AnimationFrame",
        "check_frame_count",
        "check_roots",
        "frame_octree",
        "frames_as_octants",
        "join_frames",
    ),
    "voxrt.octree.assembly": ("Assembly",),
    "voxrt.octree.budget": ("BOARDS", "Fit", "coarsen", "fit", "share", "shared_words"),
    "voxrt.octree.construct": ("build", "from_dense", "from_points"),
    "voxrt.octree.decoding": ("decode",),
    "voxrt.octree.dialects": ("DIALECTS", "Dialect", "detect_dialect", "encode"),
    "voxrt.octree.disk_assembly": ("DiskAssembly",),
    "voxrt.octree.difference": ("Difference", "Region", "diff", "differing_regions"),
    "voxrt.octree.errors": ("RomError",),
    "voxrt.octree.hidden": ("fill_hidden", "hidden_voxels", "share_hidden"),
    "voxrt.octree.leaf_arrays": ("Leaves", "leaves"),
    "voxrt.octree.lod": ("with_means",),
    "voxrt.octree.octant": ("Octant", "octant_at"),
    "voxrt.octree.octree": ("MAX_DEPTH", "Octree"),
    "voxrt.octree.owners": ("Owners",),
    "voxrt.octree.query": ("count_in_box", "material_at", "solid_bounds"),
    "voxrt.octree.rom": ("Rom",),
    "voxrt.octree.statistics": ("Census", "census"),
    "voxrt.octree.surface": ("SurfaceChange", "surface_change"),
    "voxrt.octree.vdb": ("from_vdb",),
    "voxrt.octree.voxel_arrays": ("ARRAY_LIMIT", "to_dense", "to_points"),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}

if TYPE_CHECKING:  # type checkers see these names and no others
    from voxrt.octree.animation import (
        Animation,
        AnimationFrame,
        check_frame_count,
        check_roots,
        frame_octree,
        frames_as_octants,
        join_frames,
    )
    from voxrt.octree.assembly import Assembly
    from voxrt.octree.budget import BOARDS, Fit, coarsen, fit, share, shared_words
    from voxrt.octree.construct import build, from_dense, from_points
    from voxrt.octree.decoding import decode
    from voxrt.octree.dialects import DIALECTS, Dialect, detect_dialect, encode
    from voxrt.octree.difference import Difference, Region, diff, differing_regions
    from voxrt.octree.disk_assembly import DiskAssembly
    from voxrt.octree.errors import RomError
    from voxrt.octree.hidden import fill_hidden, hidden_voxels, share_hidden
    from voxrt.octree.leaf_arrays import Leaves, leaves
    from voxrt.octree.lod import with_means
    from voxrt.octree.octant import Octant, octant_at
    from voxrt.octree.octree import MAX_DEPTH, Octree
    from voxrt.octree.owners import Owners
    from voxrt.octree.query import count_in_box, material_at, solid_bounds
    from voxrt.octree.rom import Rom
    from voxrt.octree.statistics import Census, census
    from voxrt.octree.surface import SurfaceChange, surface_change
    from voxrt.octree.vdb import from_vdb
    from voxrt.octree.voxel_arrays import ARRAY_LIMIT, to_dense, to_points
else:

    def __getattr__(name: str) -> object:
        if name in _HOME:
            return getattr(import_module(_HOME[name]), name)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
