"""voxrt in Blender: a render engine whose pixels are those of the hardware, and octree memories of the scene.

`make blender` packs this folder, with the wheels of voxrt, into one extension. The scene is read by
:mod:`voxrt.voxelize.formats.blend`, and everything behind it is voxrt's own.
"""

from . import engine, live, octants, operators, panel, settings

_PARTS = (settings, engine, operators, panel, octants, live)


def register() -> None:
    """Register all classes, in the order in which they need one another."""
    for part in _PARTS:
        part.register()


def unregister() -> None:
    """Undo :func:`register`."""
    for part in reversed(_PARTS):
        part.unregister()
