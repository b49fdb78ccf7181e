"""The command lines of what runs on hardware: serve, upload, bitstream, board and core."""

from __future__ import annotations

from pathlib import Path
from typing import Literal

from msgspec import NODEFAULT

from voxrt.options.kinds import FLAG, INTEGER, file, files, one_of, text, texts, whole
from voxrt.options.option import ARGUMENTS, Option, OptionTable, nested, option
from voxrt.options.shared import CONFIG, DEPTH, HARDWARE, OUTPUT, MessageOptions, ReportOptions

_NETWORK, _DEVICE = "Network", "Device"
_PORT = Option(whole(0, 65535, "PORT"), None, _NETWORK, "")


# A table: an option is its kind, its default and its group, then its text.
# fmt: off
class ServeCommand(OptionTable, frozen=True, kw_only=True):
    """What ``voxrt serve`` takes."""

    scenes: tuple[Path, ...] = option(files("SCENE"), (), ARGUMENTS,
        "Blobs, memories (.mem) and assets. The first is shown at once; the page lists all. Without scenes, the "
        "page lists examples and has a place to drop files.")
    device: str = option(text("model|sim|serial:PORT|tcp://BOARD:PORT"), "model", _DEVICE,
        "The renderer: the exact model, the simulated hardware, which is slow, a board at a serial line, such as "
        "serial:/dev/ttyUSB0, whose monitor follows the page, or a PYNQ board that runs voxrt-board, such as "
        "tcp://pynq:4810, with its token in the environment variable VOXRT_BOARD_TOKEN.")
    config: str = CONFIG.field(default="lit", group=_DEVICE,
        help="The configuration of the simulated hardware: tiny has no optional features, lit has all of them.")
    host: str = option(text("ADDRESS"), "127.0.0.1", _NETWORK,
        "Address to listen on. Every address but loopback needs a token.")
    port: int = _PORT.field(help="TCP port of the page; 0 takes a free one.", default=8080)
    token: str | None = option(text("TEXT"), None, _NETWORK,
        "The token that clients must send. Where one is needed and not given, a random one is made and printed. "
        "Other users of this machine see it in the command line.")
    token_file: Path | None = option(file("FILE"), None, _NETWORK, "A file whose first line is the token.")
    origin: tuple[str, ...] = option(texts("ORIGIN"), (), _NETWORK,
        "Further origins (http://NAME:PORT) whose pages may connect, such as that of a reverse proxy. This "
        "machine's own addresses and names need no option.")
    legacy_port: int | None = _PORT.field(
        help="TCP port of the legacy protocol, for the desktop client of the original project: 28 bytes in, a raw "
        "picture of 512x512 pixels out, no token.")
    depth: int | None = DEPTH.field(help="Levels of the octrees of assets.")
    reporting: ReportOptions = nested(ReportOptions)


class UploadCommand(OptionTable, frozen=True, kw_only=True):
    """What ``voxrt upload`` takes."""

    rom: Path = option(file("ROM"), NODEFAULT, ARGUMENTS,
        "A blob, or a .mem file; its manifest, the .json in the same folder, is sent with it. Or -: a file per line of "
        "standard input, each shown as its line comes; the line of a board stays open until the end.")
    to: str | None = option(text("URL"), None, _DEVICE,
        "The address of the page, with its token, as the frame server printed it. Or the serial line of a board, "
        "such as serial:/dev/ttyUSB0, or a PYNQ board that runs voxrt-board, such as tcp://pynq:4810, with its "
        "token in the environment variable VOXRT_BOARD_TOKEN.")
    device: Literal["model", "sim"] | None = option(one_of(("model", "sim")), None, _DEVICE,
        "A device of this machine, to try the upload without a server.")
    config: str = CONFIG.field(default="lit", group=_DEVICE,
        help="The configuration of the simulated hardware: tiny or lit.")
    dry_run: bool = option(FLAG, False, _DEVICE, "Check everything, write nothing.")
    reporting: ReportOptions = nested(ReportOptions)


class BitstreamCommand(OptionTable, frozen=True, kw_only=True):
    """What ``voxrt bitstream`` takes."""

    source: Path | None = option(file("ASSET|ROM"), None, ARGUMENTS,
        "An asset, or a memory: .mem or another format, with its manifest beside it. Leave it out with {selftest}.")
    board: str = option(text("NAME"), NODEFAULT, HARDWARE,
        "Name of the board, such as ulx3s-85f. Or the path of a board.json, which describes a board of yours.")
    output: Path = option(file("DIR|FILE"), Path(), OUTPUT,
        "Folder for the files, which is made if it is missing. Or the file of the bitstream: NAME.bit or .fs.",
        flags=("--output", "-o"))
    depth: int | None = DEPTH.field(help="Levels of the octree of an asset. The default is 7.")
    load: bool = option(FLAG, False, HARDWARE,
        "Load the bitstream into the board that is plugged in, by openFPGALoader.")
    selftest: bool = option(FLAG, False, HARDWARE,
        "Make the self-test of the board: colour bars, buttons, LEDs, serial line and SDRAM, without a scene. voxrt "
        "board check reads its results.")
    rebuild: bool = option(FLAG, False, HARDWARE, "Synthesize, place and route the design anew. It takes minutes.")
    seed: int | None = option(INTEGER, None, HARDWARE, "The seed of the placement, with {rebuild}.")
    reporting: ReportOptions = nested(ReportOptions)


class BoardCommand(OptionTable, frozen=True, kw_only=True):
    """What ``voxrt board`` takes."""

    action: Literal["check", "report"] = option(one_of(("check", "report")), NODEFAULT, ARGUMENTS,
        "check: read the results of the self-test that runs on the board, and say what to do. report: print what to "
        "paste into an issue.")
    device: str = option(text("serial:PORT|tcp://BOARD:PORT"), NODEFAULT, ARGUMENTS,
        "The board: a serial line, such as serial:/dev/ttyUSB0; for report also a PYNQ board that runs voxrt-board, "
        "such as tcp://pynq:4810, with its token in the environment variable VOXRT_BOARD_TOKEN.")
    views: int = option(whole(1, 128), 8, HARDWARE,
        "How many views report compares with the exact model.")
    reporting: ReportOptions = nested(ReportOptions)


class CoreCommand(OptionTable, frozen=True, kw_only=True):
    """What ``voxrt core`` takes."""

    path: bool = option(FLAG, False, HARDWARE,
        "Print the folder of the SystemVerilog sources. Its voxrt.f lists them in the order in which tools must "
        "read them; its README.md is their manual.")
    config: str | None = CONFIG.field(help="The configuration that {verilog} writes.")
    verilog: Path | None = option(file("FILE"), None, HARDWARE,
        "A .v to write: the configuration as one file of plain Verilog, top module voxrt_core, for tools that do "
        "not read the SystemVerilog sources. yosys makes it.")
    reporting: MessageOptions = nested(MessageOptions)
