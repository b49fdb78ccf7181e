"""``voxrt convert``."""

from __future__ import annotations

from pathlib import Path  # noqa: TC003 - cyclopts reads the signature
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

import voxrt
from voxrt.cli.arguments import Depth, Pixels, Reporting, Sight, choice
from voxrt.cli.configuration import find_configuration
from voxrt.cli.errors import UsageError
from voxrt.cli.lighting import supported
from voxrt.cli.memory_results import ConvertResult
from voxrt.cli.messages import name_file, summarize
from voxrt.cli.results import print_json, warning_entries
from voxrt.cli.source import read_source
from voxrt.options.build_options import Dialect  # noqa: TC001 - cyclopts reads the signature
from voxrt.outputs import check_folder, writing
from voxrt.views.writers import WORD_WRITERS

if TYPE_CHECKING:
    from voxrt.cli.source import Source


def convert(
    source: Annotated[Path, Parameter(metavar="FROM")],
    target: Annotated[Path, Parameter(metavar="TO")],
    /,
    *,
    depth: Depth = None,
    from_dialect: Annotated[Dialect | None, Parameter(converter=choice)] = None,
    dialect: Annotated[Dialect, Parameter(converter=choice)] = "report",
    material: Annotated[tuple[str, ...], Parameter(metavar="NAME=RRGGBB", show_default=False)] = (),
    form: Annotated[Literal["file", "core"], Parameter(converter=choice)] = "file",
    config: Annotated[str | None, Parameter(metavar="NAME")] = None,
    size: Pixels | None = None,
    reporting: Annotated[Reporting, Parameter(name="*", show_default=False)] = Reporting(),  # noqa: B008
) -> None:
    """Write a memory or an asset in another format. The suffixes of the files say which.

    Parameters
    ----------
    source
        A memory: .mem, .coe, .mif or .bin (with or without a manifest beside it), .blob, .vox (MagicaVoxel),
        or .txt (a node listing of the original's authoring script). Or an asset, which is built first.
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
    form
        file: one file, in the format that its suffix says. core: TO is a folder for what a core holds that shows the
        scene: rows of its block RAMs for $readmemh, boot.hex with the writes that start a frame, and scene.h for C.
    config
        With --form core: the configuration of the hardware. The default is tiny, or lit if the scene has a light or
        mirrors.
    size
        With --form core: width and height of the frame in pixels. [default: 640x480]
    reporting
        How results are printed.
    """
    if form == "core":
        if target.suffix.lower() in voxrt.WRITABLE_SUFFIXES:
            raise UsageError(f"{target}: --form core writes several files; name a folder")
        check_folder(target)
        read = read_source(source, depth, from_dialect, _colours(material), frames=True)
        files = _write_core(read, target, config, size or (640, 480))
    else:
        if config is not None or size is not None:
            raise UsageError("--config and --size are of --form core; add that, or leave them out")
        if target.suffix.lower() not in voxrt.WRITABLE_SUFFIXES:
            raise UsageError(f"{target}: is not a format to write; name one of {', '.join(voxrt.WRITABLE_SUFFIXES)}")
        check_folder(target.parent)
        whole = target.suffix.lower() in WORD_WRITERS
        read = read_source(source, depth, from_dialect, _colours(material), frames=whole)
        files = voxrt.convert(read.blob, target, dialect=dialect)
    if reporting.json:
        print_json(ConvertResult([name_file(file) for file in files], warning_entries(read.warnings)))
    else:
        summarize(f"{source.name}:", [("wrote", str(file)) for file in files])


def _write_core(source: Source, folder: Path, config: str | None, size: tuple[int, int]) -> tuple[Path, ...]:
    """Write what a core holds; remove what another configuration has left in the folder."""
    from voxrt.board.errors import Refused  # noqa: PLC0415
    from voxrt.board.view import View  # noqa: PLC0415
    from voxrt.boards.board_scenes import board_scene  # noqa: PLC0415 - NumPy comes with it
    from voxrt.boards.core_files import MEMORY_FILES, check_fit, core_files  # noqa: PLC0415
    from voxrt.export.atomic import write_together  # noqa: PLC0415

    lighting = source.blob.lighting or voxrt.Lighting()
    configuration = find_configuration(config or ("lit" if lighting.features else "tiny"))
    check_fit(source.rom, configuration)
    lighting = supported(lighting, set(configuration.features))
    view = View(source.camera(size, Sight()), size, lighting=lighting)
    try:
        made = core_files(board_scene(source.blob), view, configuration)
    except Refused as error:
        raise voxrt.ViewpointError(str(error)) from error
    files = {folder / name: data for name, data in made.items()}
    stale = [folder / name for name in MEMORY_FILES if name not in made and (folder / name).is_file()]
    with writing(next(iter(files))):
        write_together({**files, **dict.fromkeys(stale)})
    return tuple(files)


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
