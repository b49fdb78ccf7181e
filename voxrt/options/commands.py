"""The commands of ``voxrt``: what each is for, and the table of its options."""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from voxrt.options.option import OptionTable


class Command(NamedTuple):
    """A command."""

    purpose: str  # what it does, in a line
    table: str  # the module and the class of its options, in voxrt.options
    example: str  # a command line
    more: str = ""  # what the help says besides

    def options(self) -> type[OptionTable]:
        """Return the table of its options."""
        module, _, name = self.table.partition(":")
        found: type[OptionTable] = getattr(import_module(f"voxrt.options.{module}"), name)
        return found


COMMANDS = {
    "build": Command(
        "Build an asset's octree memory: NAME.mem, its manifest NAME.json and a preview picture.",
        "build_command:BuildCommand",
        "voxrt build courtyard.glb -o out --depth 7 --preview",
    ),
    "render": Command(
        "Render a picture of a memory or an asset, with the same pixels as the hardware.",
        "picture_commands:RenderCommand",
        "voxrt render courtyard.mem -o courtyard.png --position -20,40,180 --look 1,-1,-4",
    ),
    "compare": Command(
        "Compare a memory with the meshes that it was built from, as the default camera sees both.",
        "picture_commands:CompareCommand",
        "voxrt compare courtyard.mem courtyard.glb -o likeness.png",
    ),
    "view": Command(
        "Show the octants of a memory or of an asset: in a window, as a picture, or as a file for other programs.",
        "picture_commands:ViewCommand",
        "voxrt view courtyard.mem --ray 320,240 --screenshot ray.png",
        "Octants that others cover on all six sides are left out. In the window, a click on an octant shows its "
        "address, word, level, bounds and material. A slider makes small octants uniform. The key c adds a plane "
        "that cuts.",
    ),
    "trace": Command(
        "Print the path of one pixel's ray through the octree, word by word, and how the pixel gets its colour.",
        "picture_commands:TraceCommand",
        "voxrt trace courtyard.mem --pixel 320,240",
    ),
    "serve": Command(
        "Show scenes live in the browser, until Ctrl-C.",
        "board_commands:ServeCommand",
        "voxrt serve courtyard.mem dog.usda",
    ),
    "upload": Command(
        "Show another scene on a running board: its words are written, read back and compared.",
        "board_commands:UploadCommand",
        "voxrt upload courtyard.mem --to http://127.0.0.1:8080/",
    ),
    "bitstream": Command(
        "Make the bitstream of a board that shows a scene, turning, on its monitor.",
        "board_commands:BitstreamCommand",
        "voxrt bitstream courtyard.glb --board ulx3s-85f --load",
        "The scene is written into the block RAMs of a design that is placed and routed already. NAME.bit and its "
        "report NAME.report.json are written.",
    ),
    "board": Command(
        "Check a board by its self-test, or report what runs on it.",
        "board_commands:BoardCommand",
        "voxrt board check serial:/dev/ttyUSB0",
        "voxrt bitstream --board NAME --selftest --load puts the self-test on the board.",
    ),
    "convert": Command(
        "Write a memory or an asset in another format. The suffixes of the files say which.",
        "memory_commands:ConvertCommand",
        "voxrt convert courtyard.mem courtyard.blob",
    ),
    "edit": Command(
        "Edit the voxels of a memory by a script, and write the result.",
        "memory_commands:EditCommand",
        "voxrt edit courtyard.mem --script edits.jsonl -o edited.mem",
        'A line of the script is an operation, such as {"op": "fill", "sphere": {"centre": [64, 20, 64], "radius": 9}, '
        '"material": 0}. The operations are set, fill, paint, paste, material, undo and redo.',
    ),
    "info": Command(
        "Print what a memory holds: its size, levels and materials.",
        "memory_commands:InfoCommand",
        "voxrt info courtyard.mem",
    ),
    "core": Command(
        "Show the configurations of the hardware, or give its sources to a design of your own.",
        "board_commands:CoreCommand",
        "voxrt core --config octo --verilog octo.v",
        "Without options it lists the configurations.",
    ),
    "completion": Command(
        "Print a script for command-line completion, to be read by a shell at its start.",
        "shell_commands:CompletionCommand",
        'echo "source <(voxrt completion bash)" >> ~/.bashrc',
    ),
    "diff": Command(
        "Compare the voxels of two memories and print where they differ. The order of their words does not matter.",
        "memory_commands:DiffCommand",
        "voxrt diff before.mem after.mem",
    ),
    "help": Command(
        "Print the help of a command with all of its options, the command lines of a task, or all commands.",
        "shell_commands:HelpCommand",
        "voxrt help build",
    ),
}
"""By name, in the order of the help."""
