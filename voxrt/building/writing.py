"""What a build writes: words, manifest and preview, all of them or none."""

from __future__ import annotations

from contextlib import ExitStack
from typing import TYPE_CHECKING

from msgspec.structs import replace

from voxrt.building.view import preview
from voxrt.export.atomic import write_together
from voxrt.export.outputs import writing
from voxrt.export.rom_files import write_words
from voxrt.options.build_options import BuildOptions
from voxrt.options.option import options_of
from voxrt.sim import SimulatorError
from voxrt.views.viewpoint import ViewpointError

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from voxrt.building.output_files import OutputFiles
    from voxrt.building.result import BuildResult
    from voxrt.plans.stage_clock import StageClock


def named_settings(options: BuildOptions) -> dict[str, str | int | float | bool | None]:
    """Return the options that the manifest names.

    Examples
    --------
    >>> from voxrt import BuildOptions
    >>> named_settings(BuildOptions(colours=8))["colours"]
    8
    """
    settings: dict[str, str | int | float | bool | None] = {}
    for name, option in options_of(BuildOptions).items():
        value = getattr(options, name)
        if option.manifest == "always" or (option.manifest == "changed" and value != option.default):
            if isinstance(value, tuple):
                value = ", ".join(one if isinstance(one, str) else f"{one:g}" for one in value) or None
            settings[name] = value
    return settings


def write_result(
    files: OutputFiles,
    result: BuildResult,
    options: BuildOptions,
    clock: StageClock,
    rendered: Callable[[int, int], None] | None,
) -> tuple[BuildResult, Exception | None]:
    """Render the preview of a build and write its files, all of them or none, in the stages "preview" and "write".

    `rendered` is called with the rows of the preview that are done and with all rows.
    Returns the result with its preview and its outputs, and the error why there is no preview. The memory is sound
    then, so it is written, and an older preview is removed. OutputError if a file cannot be written: old files stay as
    they were.
    """
    error: Exception | None = None
    if files.preview is not None:
        with clock.stage("preview"):
            try:
                result = replace(result, preview=preview(result, options, rendered))
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
            pictures[files.preview] = result.preview._repr_png_()
    outputs: dict[str, Path] = {}
    with ExitStack() as stack:
        for path in (*pictures, files.words):
            if path is not None:
                stack.enter_context(writing(path))
        if files.words is None:
            if result.preview is not None:
                write_together(pictures)
        else:
            words = files.words
            written = write_words(words.parent, words.stem, words.suffix, result.blob, dialect, beside=pictures)
            outputs = {"mem": written.mem, "manifest": written.manifest}
    if files.preview is not None and result.preview is not None:
        outputs["preview"] = files.preview
    return outputs
