"""What the frames of an animation are made from: one asset at several times, or several assets."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING, cast

from msgspec import Struct
from msgspec.structs import replace

from voxrt.sources.source import open_source
from voxrt.voxelize import AssetError, Scene
from voxrt.voxelize.arguments import real, whole
from voxrt.voxelize.assets import SUFFIXES
from voxrt.voxelize.formats.external_files import as_text
from voxrt.voxelize.from_trimesh import is_trimesh

if TYPE_CHECKING:
    from voxrt.options.build_options import BuildOptions
    from voxrt.sources.source import Asset, Source

_MOST_FRAMES = 4096


class FrameSources(Struct, frozen=True, eq=False):
    """The opened assets of an animation."""

    name: str  # what the files of the build are called
    file_name: str | None  # that of the file or the folder that has all frames; None where there is none
    sources: tuple[Source, ...]  # one per frame; their options have the time
    names: tuple[str, ...]  # those of the frames; empty texts where all frames are of one asset


def open_frames(assets: Asset | Sequence[Asset], options: BuildOptions, times: Sequence[float] | None) -> FrameSources:
    """Open the assets of an animation.

    TypeError or ValueError if there is no frame, or times are given for several assets; AssetError if a folder has no
    asset.

    Examples
    --------
    >>> from voxrt import BuildOptions
    >>> frames = open_frames(["walk_1.glb", "walk_2.glb"], BuildOptions(), None)
    >>> frames.name, frames.names
    ('walk', ('walk_1.glb', 'walk_2.glb'))
    """
    if times is not None:
        if not _is_one(assets):
            raise ValueError("times are of one asset; give several assets without times")
        seconds = [real(f"times[{row}]", one) for row, one in enumerate(times)]
        if not 1 <= len(seconds) <= _MOST_FRAMES:
            raise ValueError(f"times must be 1 … {_MOST_FRAMES}, not {len(seconds)}")
        sources = tuple(open_source(cast("Asset", assets), replace(options, time=one)) for one in seconds)
        return FrameSources(sources[0].name, sources[0].file_name, sources, ("",) * len(sources))
    several: Sequence[Asset]
    name, file_name = "", None
    if isinstance(assets, str | os.PathLike):
        name, file_name = as_text(Path(assets).stem), as_text(Path(assets).name)
        several = frame_files(assets)
    elif _is_one(assets):
        raise ValueError("one asset is an animation only at several times; give times, or several assets")
    else:
        several = cast("Sequence[Asset]", assets)
    sources = tuple(open_source(one, options) for one in several)
    if not 1 <= len(sources) <= _MOST_FRAMES:
        raise ValueError(f"an animation has 1 … {_MOST_FRAMES} frames, not {len(sources)}")
    if file_name is None:
        name = _common_name([source.name for source in sources])
    return FrameSources(name, file_name, sources, tuple(source.file_name or source.name for source in sources))


def frame_times(start: float, stop: float, count: int) -> tuple[float, ...]:
    """Return the times of frames from `start` up to but without `stop`, evenly, so that a loop closes.

    Parameters
    ----------
    start, stop
        Seconds.
    count
        How many, 1 … 4096.

    Raises
    ------
    TypeError, ValueError
        `stop` is not after `start`, or a number is of another kind or out of range.

    Examples
    --------
    >>> frame_times(0, 2, 4)
    (0.0, 0.5, 1.0, 1.5)
    """
    start, stop = real("start", start), real("stop", stop)
    count = whole("count", count, 1, _MOST_FRAMES)
    if stop <= start:
        raise ValueError(f"stop must be after start, and {stop:g} is not after {start:g}")
    return tuple(start + (stop - start) * number / count for number in range(count))


def frame_files(folder: str | os.PathLike[str]) -> tuple[Path, ...]:
    """Find the assets of a folder, in the natural order of their names: ``walk_2`` comes before ``walk_10``.

    AssetError if it is no folder, or has no asset.

    Examples
    --------
    >>> [path.name for path in frame_files("examples")][:2]
    ['courtyard.glb', 'dog.usda']
    """
    path = Path(folder)
    if not path.is_dir():
        raise AssetError(path, "is no folder", fix="name a folder of assets")
    found = [one for one in path.iterdir() if one.suffix.lower() in SUFFIXES and one.is_file()]
    if not found:
        raise AssetError(path, "the folder has no asset", fix=f"put files there that end in {', '.join(SUFFIXES)}")
    return tuple(sorted(found, key=natural_order))


def natural_order(path: Path) -> tuple[list[tuple[str, int]], str]:
    """Return the key by which names are sorted as people do: numbers in them by their value."""
    parts = re.findall(r"(\D*)(\d*)", path.name.casefold())
    return [(text, int(digits or 0)) for text, digits in parts], str(path)


def _is_one(assets: object) -> bool:
    """Tell one asset from a sequence of assets; vertices and faces in a tuple are one."""
    if isinstance(assets, str | os.PathLike | Scene) or is_trimesh(assets):
        return True
    if not isinstance(assets, Sequence):
        raise TypeError(f"assets must be an asset or a sequence of assets, not {type(assets).__name__}")
    one = (str, os.PathLike, Scene, tuple)
    return (
        isinstance(assets, tuple)
        and len(assets) == 2
        and not any(isinstance(part, one) or is_trimesh(part) for part in assets)
    )


def _common_name(names: list[str]) -> str:
    """Return the beginning that names have in common, without a number at its end."""
    same = takewhile(lambda letters: len(set(letters)) == 1, zip(*names, strict=False))
    return "".join(letters[0] for letters in same).rstrip("0123456789-_. ") or "animation"
