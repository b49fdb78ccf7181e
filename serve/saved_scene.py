"""The present scene as files, which clients fetch."""

from __future__ import annotations

import zlib
from pathlib import Path
from typing import TYPE_CHECKING, Any

from voxrt.board.edited_scene import rom_of
from voxrt.board.errors import Refused
from voxrt.export import Blob, convert
from voxrt.export.vox import write_vox
from voxrt.octree import RomError, census
from voxrt.serve.packets import CHUNK_LIMIT, Chunk
from voxrt.serve.temporary_folder import storing, temporary_folder
from voxrt.voxelize import DoesNotFitError

if TYPE_CHECKING:
    from voxrt.board.scene import Scene

_VOX_VOXELS = 1 << 24


class SavedScene:
    """A scene as files, which a client fetches in parts; :meth:`close` removes them.

    Parameters
    ----------
    number
        The request that saved it; every part repeats it.
    scene
        The scene, with the words of a build.
    suffix
        ``.mem``, ``.blob`` or ``.vox``.

    Raises
    ------
    Refused
        The scene cannot be saved so, or the temporary folder cannot be written.
    """

    def __init__(self, number: int, scene: Scene, suffix: str) -> None:
        self.number = number
        self._folder = temporary_folder()
        try:
            with storing():
                self._paths = _write(scene, Path(self._folder.name, f"{_file_stem(scene.name)}{suffix}"))
                self._sizes = [path.stat().st_size for path in self._paths]
                self.files: list[dict[str, Any]] = [
                    {"name": path.name, "size": size, "crc32": _crc32(path)}
                    for path, size in zip(self._paths, self._sizes, strict=True)
                ]
        except (DoesNotFitError, RomError) as error:
            self.close()
            raise Refused(str(error).replace(f"{self._folder.name}/", "")) from error
        except BaseException:
            self.close()
            raise

    def part(self, offset: int) -> Chunk:
        """Read a part from a byte on, counted in all files together; Refused behind their end."""
        start = offset
        for path, size in zip(self._paths, self._sizes, strict=True):
            if start < size:
                with path.open("rb") as file:
                    file.seek(start)
                    return Chunk(self.number, offset, file.read(CHUNK_LIMIT))
            start -= size
        raise Refused(f"the files end at byte {sum(self._sizes)}, before byte {offset}")

    def close(self) -> None:
        """Remove the files."""
        self._folder.cleanup()


def _write(scene: Scene, path: Path) -> tuple[Path, ...]:
    rom = rom_of(scene)
    if path.suffix != ".vox":
        return convert(Blob(rom, scene.camera, scene.lighting), path)
    if (count := census(rom.octree).solid_voxels) > _VOX_VOXELS:
        raise Refused(f"{count:,} solid voxels are more than the {_VOX_VOXELS:,} of a .vox; save it as .blob")
    write_vox(path, rom)
    return (path,)


def _file_stem(name: str) -> str:
    """Make a file's name of a scene's."""
    return "".join(one if one.isalnum() or one in "-_." else "_" for one in name)[:60].strip(".") or "scene"


def _crc32(path: Path) -> int:
    crc = 0
    with path.open("rb") as file:
        while part := file.read(1 << 20):
            crc = zlib.crc32(part, crc)
    return crc
