"""``voxrt edit``."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec.structs import replace

import voxrt
from voxrt.building.edit_script import run_edit_script
from voxrt.cli.inputs.source import read_source
from voxrt.cli.results.build_results import print_json
from voxrt.cli.results.memory_results import EditResult
from voxrt.cli.terminal.errors import UsageError
from voxrt.cli.terminal.messages import name_file, summarize
from voxrt.export import Provenance
from voxrt.export.outputs import check_folder

if TYPE_CHECKING:
    from voxrt.options.memory_commands import EditCommand


def run(options: EditCommand) -> None:
    """Edit the voxels of a memory by a script, and write the result."""
    target = options.output
    if target.suffix.lower() not in voxrt.WRITABLE_SUFFIXES:
        raise UsageError(f"{target}: is not a format to write; name one of {', '.join(voxrt.WRITABLE_SUFFIXES)}")
    check_folder(target.parent)
    source = read_source(options.source, options.depth, frames=True)
    if source.blob.animation is not None:
        raise UsageError(f"{options.source} is an animation, whose frames share blocks; edit a memory of one scene")
    world = voxrt.World(source.rom, undo_steps=options.undo_steps)
    before = len(source.rom.octree.words)
    edits = run_edit_script(world, options.script)
    rom = world.rom()
    # The objects and the source of the build do not describe what was edited.
    edited = replace(source.blob, rom=rom, provenance=Provenance(baked=source.blob.provenance.baked))
    dialect = options.dialect or ("report" if rom.octree.means is None else "lod")
    files = voxrt.convert(edited, target, dialect=dialect)
    words = len(rom.octree.words)
    if options.reporting.json:
        print_json(EditResult([name_file(file) for file in files], source.warnings, edits, before, words))
        return
    rows = [("edits", f"{edits:,}"), ("memory", f"{words:,} words, before {before:,}")]
    summarize(f"{options.source.name}:", rows + [("wrote", str(file)) for file in files])
