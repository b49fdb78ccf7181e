"""voxrt: meshes to voxels to an octree memory to pictures ray-traced by hardware.

Each public name is imported when it is first used, so ``import voxrt`` and ``voxrt --help`` are instant::

    import voxrt

    result = voxrt.build("courtyard.glb", "out", depth=7, preview="out/courtyard.png")
    rom, warnings = voxrt.read_rom("out/courtyard.mem")
    frame = voxrt.render(rom, size=(640, 480))

The stages behind it are packages of their own: :mod:`voxrt.voxelize`, :mod:`voxrt.octree`, :mod:`voxrt.export`,
:mod:`voxrt.sim`, :mod:`voxrt.view`.
"""

import sys
from importlib import import_module

from voxrt.exports import exports_of

__version__ = "0.2.0"

__getattr__, __dir__ = exports_of(__name__)

if "IPython" in sys.modules:  # a notebook: it finds the cards on the values' classes
    import_module("voxrt.building.cards")
