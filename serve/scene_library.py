"""The scenes that a server can load."""

from __future__ import annotations

from typing import TYPE_CHECKING

from msgspec import field

from voxrt.board.errors import Refused
from voxrt.voxelize.value import Value

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from pathlib import Path

    from voxrt.serve.scene_process import SceneReader


class SceneLibrary(Value, frozen=True):
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
    >>> sorted(scene_names([Path("a/dog.mem"), Path("b/dog.mem"), Path("dog.mem.glb")]))
    ['a/dog.mem', 'b/dog.mem', 'dog.mem']
    """
    kept = list(dict.fromkeys(paths))
    ways = [(path.stem, path.name, str(path)) for path in kept]
    chosen = [0] * len(kept)
    while True:
        names = [way[number] for way, number in zip(ways, chosen, strict=True)]
        longer = [names.count(name) > 1 and number < 2 for name, number in zip(names, chosen, strict=True)]
        if not any(longer):
            return dict(zip(names, kept, strict=True))
        chosen = [number + more for number, more in zip(chosen, longer, strict=True)]
