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


def refuse_layers_outside(path: Path, external_files: ExternalFiles) -> None:
    """Refuse a stage with a layer that may not be opened, whatever variants are selected.

    Layers are opened one after another, each after its check. The stage reports layers that cannot be opened.

    Raises
    ------
    AssetError
        A layer refers to one outside the file's folder.
    """
    if external_files.allow_outside:
        return
    seen: set[str] = set()
    waiting = [Sdf.Layer.FindOrOpen(str(path))]
    while waiting:
        layer = waiting.pop()
        if not layer:
            continue
        for asset in sorted(layer.GetCompositionAssetDependencies()):
            file = layer.ComputeAbsolutePath(asset) if asset else ""
            found = found_at(file, external_files)
            if file in seen or found is None:
                continue
            seen.add(file)
            if not external_files.allows(found):
                place = "" if Path(layer.realPath) == path.resolve() else Path(layer.realPath).name
                raise AssetError(path, f"layer {asset!r} is outside the file's folder", place=place, fix=ALLOW_OUTSIDE)
            try:
                waiting.append(Sdf.Layer.FindOrOpen(file))
            except Tf.ErrorException:  # not a layer, or a broken one: the stage reports it
                continue


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
