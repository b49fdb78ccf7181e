"""``voxrt board``."""

from __future__ import annotations

import platform
from contextlib import closing
from pathlib import Path
from typing import TYPE_CHECKING

import voxrt
from voxrt.cli.commands.serve import SERIAL, TCP, board_errors, open_device, read_scene
from voxrt.cli.results.board_results import CheckResult, FindingEntry, ReportResult, ViewEntry
from voxrt.cli.results.build_results import print_json
from voxrt.cli.terminal.errors import UsageError
from voxrt.cli.terminal.messages import summarize
from voxrt.cli.terminal.progress import transfer_bar

if TYPE_CHECKING:
    from voxrt.board.board_report import ViewCheck
    from voxrt.board.device import Device
    from voxrt.board.scene import Scene
    from voxrt.board.scene_memory import Progress
    from voxrt.options.board_commands import BoardCommand

_SIZE = 160, 120
_EXAMPLE, _DEPTH = "house.obj", 5


def run(options: BoardCommand) -> None:
    """Check a board by its self-test, or report what runs on it."""
    if options.action == "check":
        _check(options)
    else:
        _report(options)


def _check(options: BoardCommand) -> None:
    from voxrt.board.designs.selftest import check_selftest  # noqa: PLC0415 - NumPy comes with it
    from voxrt.board.designs.serial_link import open_serial  # noqa: PLC0415

    if not options.device.startswith(SERIAL):
        raise UsageError(f"{options.device}: self-tests are read by a serial line; name it as serial:PORT")
    with board_errors(), closing(open_serial(options.device.removeprefix(SERIAL))) as link, transfer_bar() as progress:
        found = check_selftest(link, progress)
    if options.reporting.json:
        print_json(CheckResult(options.device, tuple(FindingEntry(each.part, each.state, each.text) for each in found)))
    else:
        rows = [(each.part, f"{each.state}: {each.text}") for each in found]
        summarize(f"the self-test of the board at {link.name}:", rows, answer=True)
    failed = [each.part for each in found if each.state == "failed"]
    if failed:
        raise voxrt.SimulatorError(f"the self-test found faults: {', '.join(failed)}; each line above says what to do")


def _report(options: BoardCommand) -> None:
    from voxrt.board.board_report import cameras_around, check_views  # noqa: PLC0415 - NumPy comes with it
    from voxrt.board.designs.serial_device import SerialDevice  # noqa: PLC0415

    if not options.device.startswith((SERIAL, TCP)):
        raise UsageError(f"{options.device} is no board; name it as serial:PORT or tcp://BOARD:PORT")
    with board_errors(), transfer_bar() as progress, closing(open_device(options.device, "")) as device:
        registers = dict(device.registers())
        loaded = device.loaded()
        scene = loaded.scene if loaded is not None and loaded.shown else _load_example(device, progress)
        size = _SIZE[0] - _SIZE[0] % device.identity.width_step, _SIZE[1]
        cameras = cameras_around(scene.depth, size, options.views)
        sends_frames = options.device.startswith(TCP)
        views = check_views(device, scene, cameras, size, progress, sends_frames=sends_frames)
        if isinstance(device, SerialDevice):
            device.show_again()
        result = _result(device, scene, views, registers)
    if options.reporting.json:
        print_json(result)
    else:
        summarize("report of a board:", report_rows(result), answer=True)


def _load_example(device: Device, progress: Progress) -> Scene:
    """Let a board without a scene show an example."""
    from voxrt.board.scene_memory import SceneMemory  # noqa: PLC0415 - NumPy comes with it

    scene = read_scene(Path(voxrt.__file__).with_name("example_scenes") / _EXAMPLE, _DEPTH)
    SceneMemory(device).load(scene, progress)
    return scene


def _result(device: Device, scene: Scene, views: list[ViewCheck], registers: dict[str, int]) -> ReportResult:
    identity = device.identity
    system = f"Python {platform.python_version()}, {platform.system()} {platform.machine()}"
    return ReportResult(
        device=identity.name,
        version=identity.version,
        clock_hz=identity.clock,
        capacity=identity.capacity,
        depth=identity.depth,
        features=tuple(sorted(identity.features)),
        scene=scene.name,
        words=len(scene.words),
        crc32=scene.crc32,
        views=tuple(
            ViewEntry(each.size, each.equal, each.crc32, each.expected_crc32, each.hits, each.expected_hits)
            for each in views
        ),
        registers=registers,
        software=f"voxrt {voxrt.__version__}, {system}",
    )


def report_rows(result: ReportResult) -> list[tuple[str, str]]:
    """Give the rows of a report: names and values."""
    clock = "" if result.clock_hz is None else f", {result.clock_hz / 1e6:.4g} MHz"
    rows = [
        ("software", result.software),
        ("board", f"{result.device}, version {result.version}{clock}"),
        ("holds", f"{result.capacity:,} words, {result.depth} levels; {', '.join(result.features) or 'no features'}"),
        ("scene", f"{result.scene}, {result.words:,} words, CRC-32 {result.crc32:08X}"),
    ]
    for number, view in enumerate(result.views):
        verdict = "equal to the exact model" if view.equal else "DIFFERS from the exact model"
        frame = "no CRC from this design" if view.crc32 is None else f"CRC-32 {view.crc32:08X}"
        expected = "" if view.equal else f"; expected {view.expected_hits:,}, {view.expected_crc32:08X}"
        columns, lines = view.size
        rows.append((f"view {number}", f"{columns}x{lines}, {view.hits:,} hits, {frame}: {verdict}{expected}"))
    rows += [(name, f"0x{value:08X}") for name, value in result.registers.items()]
    return rows
