"""What a build writes: words, manifest and preview, all of them or none."""

from __future__ import annotations

from contextlib import ExitStack
from dataclasses import replace
from typing import TYPE_CHECKING

from voxrt import export
from voxrt.building.view import preview
from voxrt.export.atomic import write_together
from voxrt.outputs import writing
from voxrt.sim import SimulatorError
from voxrt.views.viewpoint import ViewpointError

if TYPE_CHECKING:
    from pathlib import Path

    from voxrt.building.output_files import OutputFiles
    from voxrt.building.result import BuildResult
    from voxrt.options.build_options import BuildOptions
    from voxrt.plans.stage_clock import StageClock


_NAMED = ("fill", "interior", "geometry", "pow2", "up", "unit", "time", "animation", "variants", "colours", "bake")
"""The options that every manifest names."""


def named_settings(options: BuildOptions) -> dict[str, str | int | float | bool | None]:
    """Return the options that the manifest names.

    Examples
    --------
    >>> from voxrt import BuildOptions
    >>> named_settings(BuildOptions(colours=8))["colours"]
    8
    """
    settings: dict[str, str | int | float | bool | None] = {name: getattr(options, name) for name in _NAMED}
    settings["variants"] = ", ".join(options.variants) or None
    if options.ignore:
        settings["ignore"] = ", ".join(options.ignore)
    if options.bounds is not None:
        settings["bounds"] = ", ".join(f"{value:g}" for value in options.bounds)
    return settings


def write_result(
    files: OutputFiles, result: BuildResult, options: BuildOptions, clock: StageClock
) -> tuple[BuildResult, Exception | None]:
    """Render the preview of a build and write its files, all of them or none, in the stages "preview" and "write".

    Returns the result with its preview and its outputs, and the error why there is no preview. The memory is sound
    then, so it is written, and an older preview is removed. OutputError if a file cannot be written: old files stay as
    they were.
    """
    error: Exception | None = None
    if files.preview is not None:
        with clock.stage("preview"):
            try:
                result = replace(result, preview=preview(result, options))
            except (SimulatorError, ViewpointError) as problem:
                error = problem
    with clock.stage("write"):
        result.outputs.update(_write(files, result, "lod" if options.lod else options.dialect))
    return result, error


def _write(files: OutputFiles, result: BuildResult, dialect: str) -> dict[str, Path]:
    """Write the files; returns them by kind."""
    pictures: dict[Path, bytes | None] = {}
    if files.preview is not None:
        pictures[files.preview] = None
        if result.preview is not None:
            from voxrt.sim.image import encode_png  # noqa: PLC0415 - most builds make no picture

            pictures[files.preview] = encode_png(result.preview.frame.colour)
    outputs: dict[str, Path] = {}
    with ExitStack() as stack:
        for path in (*pictures, files.words):
            if path is not None:
                stack.enter_context(writing(path))
        if files.words is None:
            if result.preview is not None:
                write_together(pictures)
        else:
            written = export.write_rom(
                files.words.parent,
                result.rom,
                stem=files.words.stem,
                suffix=files.words.suffix,
                dialect=dialect,
                objects=result.objects,
                warnings=result.warnings,
                seconds=result.seconds,
                source=result.source,
                view=result.view,
                lighting=result.lighting,
                baked=result.bake,
                animation=result.animation,
                beside=pictures,
            )
            outputs = {"mem": written.mem, "manifest": written.manifest}
    if files.preview is not None and result.preview is not None:
        outputs["preview"] = files.preview
    return outputs
