"""The command line as a whole: which commands there are, and how they are read."""

from __future__ import annotations

import cyclopts

import voxrt

app = cyclopts.App(
    name="voxrt",
    version=voxrt.__version__,
    version_flags=("--version", "-V"),
    help="Meshes to voxels to an octree memory to pictures ray-traced by hardware.",
    help_epilogue="Example: voxrt build courtyard.glb -o out --preview",
    help_format="plaintext",
    default_parameter=cyclopts.Parameter(negative=()),
    result_action="return_value",
    exit_on_error=False,
    print_error=False,
    suppress_keyboard_interrupt=False,
)


def _add_command(name: str, purpose: str, example: str, help_format: str = "markdown") -> None:
    # Named by text: a command is imported when it is called.
    app.command(
        f"voxrt.cli.{name}:{name}",
        name=name,
        help=purpose,
        help_epilogue=f"Example: {example}",
        help_format=help_format,
    )


_add_command(
    "build",
    "Build an asset's octree memory: NAME.mem, its manifest NAME.json and a preview picture.",
    "voxrt build courtyard.glb -o out --depth 7 --preview",
    "plaintext",  # its texts have no line breaks of their own, and Markdown is slow to import
)
_add_command(
    "render",
    "Render a picture of a memory, with the same pixels as the hardware.",
    "voxrt render courtyard.mem -o courtyard.png --position -20,40,180 --look 1,-1,-4",
)
_add_command(
    "compare",
    "Compare a memory with the meshes that it was built from.",
    "voxrt compare courtyard.mem courtyard.glb -o likeness.png",
)
_add_command(
    "view",
    "Show the octants of a memory or of an asset: in a window, as a picture, or as a file for other programs.",
    "voxrt view courtyard.mem --ray 320,240 --screenshot ray.png",
)
_add_command(
    "trace",
    "Print the path of one pixel's ray through the octree, word by word.",
    "voxrt trace courtyard.mem --pixel 320,240",
)
_add_command(
    "serve",
    "Show scenes live in the browser, until interrupted.",
    "voxrt serve courtyard.mem dog.usda",
)
_add_command(
    "upload",
    "Let a running board show another scene.",
    "voxrt upload courtyard.mem --to http://127.0.0.1:8080/",
)
_add_command(
    "bitstream",
    "Make the bitstream of a board that shows a scene on its monitor.",
    "voxrt bitstream courtyard.glb --board ulx3s-85f --load",
)
_add_command("convert", "Write a memory in another format.", "voxrt convert courtyard.mem courtyard.blob")
_add_command("info", "Print what a memory holds: sizes, levels, materials.", "voxrt info courtyard.mem")
_add_command(
    "core",
    "Show the configurations of the hardware, or give its sources to a design of your own.",
    "voxrt core --config octo --verilog octo.v",
)
_add_command(
    "completion",
    "Print a script for command-line completion, to be read by a shell at its start.",
    'echo "source <(voxrt completion bash)" >> ~/.bashrc',
)
_add_command("diff", "Compare the voxels of two memories.", "voxrt diff before.mem after.mem")


_add_command("help", "Print the help of a command, or of all.", "voxrt help build")
