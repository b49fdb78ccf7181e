"""OFF files, read by trimesh."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec.structs import replace

from voxrt.voxelize.errors import DAMAGED, AssetError, SceneWarning
from voxrt.voxelize.formats.external_files import asset_name, read_asset
from voxrt.voxelize.formats.opacity import nothing_shown
from voxrt.voxelize.formats.written_numbers import is_number, not_a_number
from voxrt.voxelize.from_trimesh import trimesh_scene

if TYPE_CHECKING:
    from voxrt.voxelize.assets import UpAxis
    from voxrt.voxelize.scene import Scene


def load_off(path: str | Path, *, up: UpAxis | None = None, unit: float | None = None) -> Scene:
    """Read an OFF file: one object. Its colours are not read, with a warning.

    `up` and `unit` are as for :func:`voxrt.voxelize.load`. AssetError where it cannot be read.
    """
    import trimesh  # noqa: PLC0415 - it is slow to import

    path = Path(path)
    data = read_asset(path)
    try:
        scene = trimesh.load_scene(io.BytesIO(data), file_type="off", process=False)
    except MemoryError:
        raise
    except Exception as error:  # noqa: BLE001 - it raises whatever its parsers do
        comma = next((word for word in data.split() if b"," in word and not is_number(word)), None)
        if comma is not None:
            raise not_a_number(path, comma, "") from None
        raise AssetError(path, f"trimesh cannot read it ({type(error).__name__})", fix=DAMAGED) from None
    try:
        made = trimesh_scene(next(iter(scene.geometry.values()), scene), name=asset_name(path), up=up, unit=unit)
    except (TypeError, ValueError) as error:
        raise AssetError(path, str(error), fix=DAMAGED) from None
    if not any(len(one.mesh.triangles) for one in made.objects):
        raise nothing_shown(path, made.warnings)
    if not _has_colours(data):
        return made
    warning = SceneWarning("vertex-colour", "the colours of OFF files are not read: convert it to PLY")
    return replace(made, warnings=(*made.warnings, warning))


def _has_colours(data: bytes) -> bool:
    """Tell whether a file has colours: of its vertices, by its first word, or of its last face, after the corners."""
    if b"C" in data.lstrip(b"\xef\xbb\xbf").split(maxsplit=1)[0].partition(b"OFF")[0]:
        return True
    last = data.rstrip().rpartition(b"\n")[2].partition(b"#")[0].split()
    return len(last) > 0 and last[0].isdigit() and len(last) > int(last[0][:9]) + 1
