"""The files of a stage's layers: checked before the stage is opened, which would open them all."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from pxr import Ar, Sdf, Tf

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.external_files import ALLOW_OUTSIDE

if TYPE_CHECKING:
    from pxr import Usd

    from voxrt.voxelize.formats.external_files import ExternalFiles
    from voxrt.voxelize.formats.usd.limits import Allowance


def open_layers(path: Path, external_files: ExternalFiles, allowance: Allowance) -> list[Sdf.Layer]:
    """Open the layers that a stage may use, whatever variants are selected, one after another, each after its check.

    Layers that cannot be opened are left out: the stage reports them. The stage takes the returned layers as they are
    while they are kept. Raise AssetError for a layer that refers to one outside the file's folder.
    """
    allowance.add(path.stat().st_size)
    seen: set[str] = set()
    waiting = [Sdf.Layer.FindOrOpen(str(path))]
    opened = []
    while waiting:
        layer = waiting.pop()
        if not layer:
            continue
        opened.append(layer)
        for asset in sorted(layer.GetCompositionAssetDependencies()):
            file = layer.ComputeAbsolutePath(asset) if asset else ""
            found = found_at(file, external_files)
            if file in seen or found is None:
                continue
            seen.add(file)
            if not external_files.allows(found):
                place = "" if Path(layer.realPath).resolve() == path.resolve() else Path(layer.realPath).name
                raise AssetError(path, f"layer {asset!r} is outside the file's folder", place=place, fix=ALLOW_OUTSIDE)
            allowance.add(found.stat().st_size)
            try:
                waiting.append(Sdf.Layer.FindOrOpen(file))
            except Tf.ErrorException:  # not a layer, or a broken one: the stage reports it
                continue
    return opened


def refuse_layers_used_outside(path: Path, stage: Usd.Stage, external_files: ExternalFiles) -> None:
    """Refuse an open stage that uses a layer from elsewhere, by an expression or as a value clip."""
    for layer in stage.GetUsedLayers():
        found = found_at(layer.realPath, external_files)
        if found is not None and not external_files.allows(found):
            raise AssetError(path, f"layer {found.name!r} is outside the file's folder", fix=ALLOW_OUTSIDE)


def found_at(file: str, external_files: ExternalFiles) -> Path | None:
    """Return the file at a path, or the package that holds it; None where there is none."""
    outer = Ar.SplitPackageRelativePathOuter(file)[0] if file else ""
    return external_files.find(outer) if outer else None
