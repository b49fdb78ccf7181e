"""The scenes that a server can load."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ..board.errors import Refused

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from ..board.scene import Scene
    from .scene_files import SceneReader


@dataclass(frozen=True, slots=True)
class SceneLibrary:
    """The reader of uploaded files, and the server's own scenes.

    Attributes
    ----------
    reader
        Makes scenes from uploaded files.
    scenes
        Functions that read the server's own scenes, by name.
    """

    reader: SceneReader
    scenes: Mapping[str, Callable[[], Scene]] = field(default_factory=dict)

    def find(self, name: str) -> Callable[[], Scene]:
        """Return the function that reads the scene `name`.

        Raises
        ------
        Refused
            There is no scene with this name.
        """
        if name not in self.scenes:
            raise Refused(f"there is no scene {name!r}; there are {', '.join(sorted(self.scenes)) or 'none'}")
        return self.scenes[name]
