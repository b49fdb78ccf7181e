"""Scenes made by people: in Python with :class:`Author`, and as ``scene.toml`` files, which the same class builds.

>>> from voxrt.voxelize import authoring
>>> yard = authoring.Author("yard")
>>> _ = yard.material("grass", "#3f7f2f")
>>> _ = yard.material("stone", (150, 150, 160))
>>> yard.add("lawn", authoring.box((8, 0.5, 8), centre=(0, -0.25, 0)), material="grass", collider="box")
>>> well = authoring.cylinder(1, 1.5) - authoring.cylinder(0.8, 2)
>>> yard.add("well", well, material="stone", translate=(2, 0.75, 1))
>>> yard.build()
Scene(name='yard', objects=2, triangles=1036, materials=3, warnings=0)

:mod:`voxrt.voxelize.authoring.scene_toml` describes the file.
"""

from voxrt.exports import exports_of

__getattr__, __dir__ = exports_of(__name__)
