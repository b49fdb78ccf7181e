"""Loading USD files, each in a process of its own, which costs about a tenth of a second.

usd-core is a large C++ library that trusts its files (``reader_process``); this process never imports it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.voxelize.formats.opacity import OPAQUE_FROM
from voxrt.voxelize.formats.reader_process.limits import Limits
from voxrt.voxelize.formats.reader_process.parent import Reader, read_apart, reader_module
from voxrt.voxelize.formats.usd.request import UsdRequest

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from voxrt.voxelize.scene import Scene

_CHILD = "voxrt.voxelize.formats.usd.child"
_SEARCH_PATH = "PXR_AR_DEFAULT_SEARCH_PATH"  # folders in which usd-core looks for layers


def read_isolated(
    path: Path,
    *,
    variants: Sequence[str] = (),
    time: float | None = None,
    allow_outside: bool = False,
    opaque_from: float = OPAQUE_FROM,
    limits: Limits | None = None,
) -> Scene:
    """Read a USD stage in a process of its own, within limits on its memory and its time.

    The scene shows the active, visible prims of purpose ``default`` and ``render``, with instances, the copies of point
    instancers, and skinned meshes in their pose. The unit and the up axis are the root layer's, as in USD: layers that
    it refers to are not rescaled, and counted where they disagree.

    Parameters
    ----------
    path
        A ``.usd``, ``.usda``, ``.usdc`` or ``.usdz`` file.
    variants
        Variants to select, in this order: ``"/prim/path:set=name"``.
    time
        Seconds after the stage's start; None for the start.
    allow_outside
        Whether layers and textures may stand outside the file's folder.
    opaque_from
        Faces of lower opacity are left out, unless their material has an opacity threshold of its own.
    limits
        What reading a small file may take; larger files may take more. None for the limits of this machine.

    Returns
    -------
    Scene
        One object per prim and copy, named by its prim path; materials in order of first use; the stage's cameras.

    Raises
    ------
    AssetError
        The stage cannot be opened, contradicts itself, shows nothing, exceeds the limits, or ends the process that
        reads it.
    DoesNotFitError
        More than 255 materials or a million objects.
    """
    request = UsdRequest(
        limits=limits or Limits.of_this_machine(),
        variants=tuple(variants),
        time=time,
        allow_outside=allow_outside,
        opaque_from=opaque_from,
    )
    reader = Reader(
        "usd-core",
        reader_module(_CHILD),
        too_slow="repair it, or flatten it with usdcat",
        environment={"PXR_WORK_THREAD_LIMIT": "4"},
        removed=() if allow_outside else (_SEARCH_PATH,),
    )
    return read_apart(reader, path, request)
