"""``voxrt upload``."""

from __future__ import annotations

import asyncio
from pathlib import Path  # noqa: TC003 - cyclopts reads the annotations
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

import voxrt
from voxrt.cli.arguments import Reporting, UsageError
from voxrt.cli.board_results import UploadResult
from voxrt.cli.messages import summarize, transfer_bar
from voxrt.cli.results import print_json
from voxrt.cli.serve import open_device

if TYPE_CHECKING:
    from voxrt.board.device import Device
    from voxrt.board.scene_memory import Progress


def upload(
    rom: Annotated[Path, Parameter(metavar="ROM")],
    /,
    *,
    to: Annotated[str | None, Parameter(metavar="URL")] = None,
    device: Literal["model", "sim"] | None = None,
    config: Annotated[str, Parameter(metavar="NAME")] = "tiny",
    dry_run: Annotated[bool, Parameter(negative=(), show_default=False)] = False,
    reporting: Annotated[Reporting, Parameter(name="*", show_default=False)] = Reporting(),  # noqa: B008
) -> None:
    """Let a running board show another scene: written at a frame boundary, read back, compared.

    Parameters
    ----------
    rom
        A .mem file; its manifest, the .json beside it, goes with it.
    to
        The page's address, as the frame server printed it, with its token.
    device
        Instead of a server: a device of this machine, to try the upload on.
    config
        The configuration of the verilated hardware.
    dry_run
        Check everything, write nothing.
    reporting
        How to tell what was done.
    """
    if (to is None) == (device is None):
        raise UsageError("--to and --device exclude each other; give one of them")
    memory, _warnings = voxrt.read_rom(rom)
    with transfer_bar() as progress:
        if to is not None:
            scene = asyncio.run(_send(rom, memory, to, progress, dry_run=dry_run))
        else:
            scene = _write(memory, open_device(device or "model", config), progress, dry_run=dry_run)
    done = "checked; nothing was written" if dry_run else "runs now"
    if reporting.json:
        print_json(UploadResult(**scene, written=not dry_run))
    else:
        summarize(f"{rom.name}: {done}", [("words", str(scene["words"])), ("crc-32", f"{scene['crc32']:08X}")])


async def _send(rom: Path, memory: voxrt.Rom, url: str, progress: Progress, *, dry_run: bool) -> dict[str, Any]:
    from voxrt.board.client import visit  # noqa: PLC0415 - websockets comes with it
    from voxrt.board.errors import Refused  # noqa: PLC0415

    try:
        async with visit(url) as client:
            _check_fit(memory, client.hello["device"])
            await client.take()
            files = {path.name: path.read_bytes() for path in (rom, rom.with_suffix(".json")) if path.exists()}
            scene: dict[str, Any] = (await client.upload(files, progress, check_only=dry_run))["scene"]
    except Refused as refusal:
        raise voxrt.SimulatorError(str(refusal)) from refusal
    return scene


def _check_fit(memory: voxrt.Rom, board: dict[str, Any]) -> None:
    words, depth = len(memory.octree.words), memory.octree.depth
    if words > board["capacity"] or depth > board["depth"]:
        raise voxrt.DoesNotFitError(
            f"{memory.name} has {words} words and {depth} levels, and {board['name']} takes {board['capacity']} and "
            f"{board['depth']}; build it with a smaller --depth"
        )


def _write(memory: voxrt.Rom, device: Device, progress: Progress, *, dry_run: bool) -> dict[str, Any]:
    from voxrt.board.errors import DeviceError, Refused  # noqa: PLC0415 - only this command needs them
    from voxrt.board.scene_memory import SceneMemory  # noqa: PLC0415
    from voxrt.staging import board_scene  # noqa: PLC0415

    scene = board_scene(memory)
    scene_memory = SceneMemory(device)
    try:
        if dry_run:
            scene_memory.check(scene)
        else:
            scene_memory.swap(scene, progress)
    except Refused as refusal:
        raise voxrt.DoesNotFitError(str(refusal)) from refusal
    except DeviceError as error:
        raise voxrt.SimulatorError(str(error)) from error
    return {"name": scene.name, "depth": scene.depth, "words": len(scene.words), "crc32": scene.crc32}
