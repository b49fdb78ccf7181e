"""The files of a stage's layers. Those outside of its folder are refused three times.

Before a layer is opened, the names in the layers that ask for it are looked at. If USD asks in a way that is not looked
at, the kernel refuses to open the file (``child.py``). Where the kernel cannot do that, all layers are looked at after
the scene has been read, and nothing of the scene is handed on.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from pxr import Ar, Sdf, Tf

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.external_files import ALLOW_OUTSIDE

if TYPE_CHECKING:
    from voxrt.voxelize.formats.external_files import ExternalFiles
    from voxrt.voxelize.formats.reader_process.limits import Allowance


def open_layers(path: Path, external_files: ExternalFiles, allowance: Allowance) -> list[Sdf.Layer]:
    """Open the layers that a stage may use, whatever variants are selected, one after another, each after its check.

    Layers that cannot be opened are left out: the stage reports them. The stage takes the returned layers as they are
    while they are kept. Raise AssetError for a layer that refers to one outside the file's folder.
    """
    allowance.add(path.stat().st_size)
    seen: set[str] = set()
    waiting = [Sdf.Layer.FindOrOpen(str(path))]
    opened = []
    variables: dict[str, object] = {}  # of expressions; those of stronger layers win
    while waiting:
        layer = waiting.pop()
        if not layer:
            continue
        opened.append(layer)
        variables = {**layer.expressionVariables, **variables}
        for asset in sorted({*layer.GetCompositionAssetDependencies(), *_clips_of(layer)}):
            file = _file_of(asset, layer, variables)
            if not file or file in seen:
                continue
            seen.add(file)
            outer = outer_file(file)
            if external_files.is_outside(outer):
                place = "" if layer == opened[0] else Path(layer.realPath).name
                raise AssetError(path, f"layer {asset!r} is outside the file's folder", place=place, fix=ALLOW_OUTSIDE)
            found = external_files.find(outer)
            if found is None:
                continue
            allowance.add(found.stat().st_size)
            try:
                waiting.append(Sdf.Layer.FindOrOpen(file))
            except Tf.ErrorException:  # not a layer, or a broken one: the stage reports it
                continue
    return opened


def refuse_layers_opened_outside(path: Path, external_files: ExternalFiles, before: set[Sdf.Layer]) -> None:
    """Refuse a scene for which USD has opened a layer from elsewhere, however it came to do so.

    `before` holds the layers that were open before.
    """
    for layer in set(Sdf.Layer.GetLoadedLayers()) - before:
        real = outer_file(layer.realPath)
        if real and Path(real).resolve() != path.resolve() and external_files.is_outside(real):
            raise AssetError(path, f"layer {Path(real).name!r} is outside the file's folder", fix=ALLOW_OUTSIDE)


def outer_file(file: str) -> str:
    """Return the path of a file, or that of the package that holds it."""
    return str(Ar.SplitPackageRelativePathOuter(file)[0]) if file else ""


def _file_of(asset: str, layer: Sdf.Layer, variables: dict[str, object]) -> str:
    """Return the path of the file that a layer's `asset` means; empty for none."""
    if Sdf.VariableExpression.IsExpression(asset):
        asset = str(Sdf.VariableExpression(asset).Evaluate(variables).value or "")
    if not asset:
        return ""
    file = layer.ComputeAbsolutePath(asset)
    return str(Ar.GetResolver().Resolve(file)) or file


def _clips_of(layer: Sdf.Layer) -> set[str]:
    """Return the files that a layer's value clips name, and the folders where a template looks for them."""
    found: set[str] = set()

    def look(place: Sdf.Path) -> None:
        if place.IsPropertyPath():
            return
        spec = layer.GetObjectAtPath(place)
        clips = spec.GetInfo("clips") if spec and spec.HasInfo("clips") else {}
        for one in clips.values():
            if isinstance(one, dict):
                found.update(_files_of_clips(one))

    layer.Traverse(Sdf.Path.absoluteRootPath, look)
    return found


def _files_of_clips(clips: dict[str, object]) -> list[str]:
    """Return the files that a set of value clips names."""
    named = clips.get("assetPaths") or ()
    listed = [*named] if isinstance(named, Sdf.AssetPathArray) else []
    return [
        *(one.path for one in [*listed, clips.get("manifestAssetPath")] if isinstance(one, Sdf.AssetPath)),
        *(one for one in [clips.get("templateAssetPath")] if isinstance(one, str)),
    ]
