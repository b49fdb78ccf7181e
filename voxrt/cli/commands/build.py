"""``voxrt build``."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from voxrt.cli.commands.building import build_all, check_company, check_frames
from voxrt.cli.terminal.errors import UsageError
from voxrt.options.build_options import BuildOptions

if TYPE_CHECKING:
    from voxrt.options.build_command import BuildCommand


def run(command: BuildCommand) -> None:
    """Build the octree memory of an asset: NAME.mem, its manifest NAME.json and a preview picture."""
    options = command.options
    if not options.bake and any(
        getattr(options, name) != getattr(BuildOptions, name) for name in ("sun", "sky", "bake_samples")
    ):
        raise UsageError("--sun, --sky and --bake-samples are of baked light: give --bake as well")
    if command.board is not None:
        if options.budget is not None:
            raise UsageError("--budget and --board exclude each other; give one of them")
        options = replace(options, budget=command.board)
    if command.frames is None:
        check_company(command.assets, command.output, options.preview)
    else:
        check_frames(command)
    build_all(replace(command, options=options))
