"""``scene.toml``: scenes written by hand.

.. code-block:: toml

    background = "#9fc5e8"

    [materials.stone]
    colour = "#9a9aa0"

    [materials.pond]
    colour = [40, 90, 120]
    mirror = true

    [[objects]]                        # the first object that fills a voxel keeps it
    name = "house"
    asset = { file = "house.obj", unit = 0.01 }
    translate = [2, 0, 0]
    rotate = [0, 90, 0]                # degrees about x, then y, then z

    [[objects]]
    name = "well"
    material = "stone"
    difference = [
        { cylinder = { radius = 1, height = 1.5 } },
        { cylinder = { radius = 0.8, height = 2 } },
    ]

    [[objects]]
    name = "step"
    box = { size = [1, 0.25, 0.5], corner = [0, 0, 2] }
    material = "stone"
    collider = "box"

    [camera]
    eye = [6, 4, 9]
    target = [0, 1, 0]

    [light]
    position = [3, 8, 4]

:mod:`voxrt.voxelize.authoring.scene_toml.schema` lists every key.
"""

from voxrt.voxelize.authoring.scene_toml.load import load_scene_toml

__all__ = ["load_scene_toml"]
