"""The scenes that a server can load."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from ..board.errors import Refused

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from .scene_process import SceneReader


@dataclass(frozen=True, slots=True)
class SceneLibrary:
    """The reader of files, and the server's own scenes.

    Attributes
    ----------
    reader
        Makes scenes from uploaded files.
    scenes
        Files of the server's own scenes, by name.
    scene_reader
        Makes scenes from the server's own files; None for `reader`.
    """

    reader: SceneReader
    scenes: Mapping[str, Sequence[Path]] = field(default_factory=dict)
    scene_reader: SceneReader | None = None

    def find(self, name: str) -> Sequence[Path]:
        """Return the files of the scene `name`.

        Raises
        ------
        Refused
            There is no scene with this name.
        """
        if name not in self.scenes:
            raise Refused(f"there is no scene {name!r}; there are {', '.join(sorted(self.scenes)) or 'none'}")
        return self.scenes[name]


def scene_names(paths: Sequence[Path]) -> dict[str, Path]:
    """Name scenes by their files: without suffix where that tells them apart, else with it, else by the whole path.

    Examples
    --------
    >>> from pathlib import Path
    >>> sorted(scene_names([Path("a/dog.mem"), Path("b/cat.mem"), Path("b/cat.glb")]))
    ['cat.glb', 'cat.mem', 'dog']
    """
    stems, names = [path.stem for path in paths], [path.name for path in paths]
    return {
        stem if stems.count(stem) == 1 else name if names.count(name) == 1 else str(path): path
        for path, stem, name in zip(paths, stems, names, strict=True)
    }
