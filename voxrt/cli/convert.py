"""``voxrt convert``."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - cyclopts reads the signature
from typing import Annotated

from cyclopts import Parameter

import voxrt
from voxrt.build_options import Dialect  # noqa: TC001 - cyclopts reads the signature
from voxrt.cli.arguments import Depth, Reporting, UsageError, choice
from voxrt.cli.memory_results import ConvertResult
from voxrt.cli.messages import name_file, summarize
from voxrt.cli.results import print_json, warning_entries
from voxrt.cli.source import read_source
from voxrt.outputs import check_folder


def convert(
    source: Annotated[Path, Parameter(metavar="FROM")],
    target: Annotated[Path, Parameter(metavar="TO")],
    /,
    *,
    depth: Depth = None,
    from_dialect: Annotated[Dialect | None, Parameter(converter=choice)] = None,
    dialect: Annotated[Dialect, Parameter(converter=choice)] = "report",
    material: Annotated[tuple[str, ...], Parameter(metavar="NAME=RRGGBB", show_default=False)] = (),
    reporting: Annotated[Reporting, Parameter(name="*", show_default=False)] = Reporting(),  # noqa: B008
) -> None:
    """Write a memory or an asset in another format. The suffixes of the files say which.

    Parameters
    ----------
    source
        A memory: .mem, .coe, .mif or .bin (with or without a manifest beside it), .blob, .vox (MagicaVoxel), or .txt
        (a node listing of the original's authoring script). Or an asset, which is built first.
    target
        The file to write. Whole memories: .mem, .coe, .mif or .bin, each with a manifest beside it, or .blob. For
        other programs: .vox (MagicaVoxel), .npz (NumPy), .ply, .glb (glTF), .vtu (ParaView, PyVista) or .html.
    depth
        Levels of the octree, for an asset or if FROM does not state them.
    from_dialect
        How FROM encodes materials, if it does not state that.
    dialect
        How TO encodes materials.
    material
        Name and colour of a material of a node listing. Give the option once per material, in the order of their ids.
    reporting
        How results are printed.
    """
    if target.suffix.lower() not in voxrt.WRITABLE_SUFFIXES:
        raise UsageError(f"{target}: is not a format to write; name one of {', '.join(voxrt.WRITABLE_SUFFIXES)}")
    check_folder(target.parent)
    read = read_source(source, depth, from_dialect, _colours(material))
    files = voxrt.convert(read.blob, target, dialect=dialect)
    if reporting.json:
        print_json(ConvertResult([name_file(file) for file in files], warning_entries(read.warnings)))
    else:
        summarize(f"{source.name}:", [("wrote", str(file)) for file in files])


def _colours(materials: tuple[str, ...]) -> dict[str, tuple[int, int, int]]:
    colours = {}
    for material in materials:
        name, _, digits = material.rpartition("=")
        try:
            red, green, blue = bytes.fromhex(digits.removeprefix("#"))
        except ValueError:
            raise UsageError(f"--material {material} is not NAME=RRGGBB, such as Roof=d65438") from None
        colours[name] = (red, green, blue)
    return colours
