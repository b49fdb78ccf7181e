"""Where the layers of a stage stand: read before the stage is opened, which would open them all."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from pxr import Ar, Sdf, Tf

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.companions import ALLOW_OUTSIDE

if TYPE_CHECKING:
    from pxr import Usd

    from voxrt.voxelize.formats.companions import Companions


def refuse_layers_outside(path: Path, companions: Companions) -> None:
    """Refuse a stage of which a layer that may not be opened is a part, whatever variants are selected.

    Layers are opened one after another, each only once it is known to be allowed; those that cannot be opened are left
    to the stage to report.

    Raises
    ------
    AssetError
        A layer refers to one outside the file's folder.
    """
    if companions.allow_outside:
        return
    seen: set[str] = set()
    waiting = [Sdf.Layer.FindOrOpen(str(path))]
    while waiting:
        layer = waiting.pop()
        if not layer:
            continue
        for asset in sorted(layer.GetCompositionAssetDependencies()):
            file = layer.ComputeAbsolutePath(asset) if asset else ""
            found = found_at(file, companions)
            if file in seen or found is None:
                continue
            seen.add(file)
            if not companions.allows(found):
                place = "" if Path(layer.realPath) == path.resolve() else Path(layer.realPath).name
                raise AssetError(
                    path, f"layer {asset!r} lies outside the file's folder", place=place, fix=ALLOW_OUTSIDE
                )
            try:
                waiting.append(Sdf.Layer.FindOrOpen(file))
            except Tf.ErrorException:  # no layer, or a broken one: for the stage to say
                continue


def refuse_layers_used_outside(path: Path, stage: Usd.Stage, companions: Companions) -> None:
    """Refuse an open stage that took a layer from elsewhere all the same, by an expression or as a value clip."""
    for layer in stage.GetUsedLayers():
        found = found_at(layer.realPath, companions)
        if found is not None and not companions.allows(found):
            raise AssetError(path, f"layer {found.name!r} lies outside the file's folder", fix=ALLOW_OUTSIDE)


def found_at(file: str, companions: Companions) -> Path | None:
    """Return the file that `file` leads to: itself, or the package that it is in; None where there is none."""
    outer = Ar.SplitPackageRelativePathOuter(file)[0] if file else ""
    return companions.find(outer) if outer else None
