"""Materials: what a voxel's id stands for."""

from __future__ import annotations

from msgspec.structs import force_setattr

from voxrt.voxelize import arguments
from voxrt.voxelize.value import Value


class Material(Value, frozen=True):
    """A uniform material. Its id is its index in :attr:`Scene.materials <voxrt.voxelize.Scene.materials>`.

    Attributes
    ----------
    name
        The author's name for it, unique in its scene.
    colour
        sRGB, three integers 0 … 255.
    mirror
        Whether it reflects. Hardware without mirrors shows `colour`.
    authored
        False for a default material, which replaces one that the author did not give.

    Raises
    ------
    TypeError, ValueError
        A value of the wrong kind, or a channel out of range.

    Examples
    --------
    >>> Material("grass", (63, 127, 47))
    Material(name='grass', colour=(63, 127, 47), mirror=False, authored=True)
    """

    name: str
    colour: tuple[int, int, int]
    mirror: bool = False
    authored: bool = True

    def __post_init__(self) -> None:
        force_setattr(self, "name", arguments.text("Material.name", self.name))
        force_setattr(self, "colour", arguments.colour("Material.colour", self.colour))
        force_setattr(self, "mirror", arguments.flag("Material.mirror", self.mirror))
        force_setattr(self, "authored", arguments.flag("Material.authored", self.authored))


EMPTY = Material("empty", (24, 28, 36))
"""Entry 0 of every material table: empty space. Its colour is the background: dark, so that faces stand out, and not
black, so that shaded edges stand out too."""

DEFAULT_COLOUR = (200, 200, 200)
"""The sRGB colour of the default material."""

MATERIAL_LIMIT = 255
"""The highest material id: a memory word holds 8 bits, and id 0 is empty space."""
