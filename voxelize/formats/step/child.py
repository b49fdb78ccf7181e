"""The process that reads one STEP file: ``python -m voxrt.voxelize.formats.step.child PATH REQUEST``."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from msgspec.structs import replace

from voxrt.voxelize.errors import DAMAGED, AssetError
from voxrt.voxelize.formats.external_files import asset_name
from voxrt.voxelize.formats.reader_process.child import serve_reader
from voxrt.voxelize.formats.reader_process.limits import Request
from voxrt.voxelize.formats.scene_frame import scene_transform

if TYPE_CHECKING:
    from voxrt.voxelize.formats.reader_process.limits import Allowance
    from voxrt.voxelize.scene import Scene


def _read(path: Path, request: Request, allowance: Allowance) -> Scene:
    import cascadio  # noqa: PLC0415 - within the limits

    from voxrt.voxelize.formats.gltf import load_gltf  # noqa: PLC0415 - it is slow to import

    allowance.add(path.stat().st_size)
    with tempfile.TemporaryDirectory() as folder:
        made = Path(folder, f"{asset_name(path)[:64] or 'part'}.glb")
        if cascadio.step_to_glb(str(path), str(made)) or not made.exists():
            raise AssetError(path, "OpenCASCADE cannot read it", fix=DAMAGED)
        try:
            scene = load_gltf(made, opaque_from=request.opaque_from)
        except AssetError as error:
            raise AssetError(path, error.problem, fix=DAMAGED) from None
    upright = scene_transform("z", None)  # which CAD programs mean: the format does not say
    objects = tuple(replace(one, transform=upright @ one.transform) for one in scene.objects)
    return replace(scene, name=asset_name(path), objects=objects)


if __name__ == "__main__":
    serve_reader(Request, _read)
