"""Benchmark of ``--frames``: the words of the frames of animations in one memory, and of each frame alone.

Usage: ``python bench/animation.py [--write] [--plot FILE]``. ``--write`` puts the table into
``bench/results/animation.md`` as well. ``--plot`` draws the words against the number of frames. Scenes: the ball of the
gallery, and the animated assets that are there.
"""

from __future__ import annotations

import json
import time
from pathlib import Path
from runpy import run_path
from typing import TYPE_CHECKING

import numpy as np
from report import ASSETS, ROOT, options_of, publish, table

import voxrt
from voxrt import octree

if TYPE_CHECKING:
    from collections.abc import Iterator

HEAD = ("scene", "moves", "frames", "depth", "words alone", "words together", "ratio", "seconds")
FRAMES = 24
ABOUT = """# Animation

Words of the frames of an animation, each in a memory of its own, and together in one, where equal blocks of
all frames are stored once. Frames are spread evenly over the animation. Written by `python bench/animation.py --write`.

"""

ANIMATED = (
    ("gltf/trimesh/CesiumMilkTruck.glb", "", "rigid parts: wheels", (0.0, 1.25)),
    ("gltf/bevy/animated/Fox.glb", "Survey", "a skinned body", (0.0, 3.4)),
    ("gltf/bevy/animated/Fox.glb", "Run", "a skinned body", (0.0, 1.15)),
    ("gltf/bevy/animated/MorphStressTest.gltf", "0", "morph targets", (0.0, 1.2)),
)
"""File, animation, what moves, and seconds from start to stop."""


def scenes(depths: tuple[int, ...]) -> Iterator[tuple[str, str, voxrt.BuildResult]]:
    """Give the name of each animation, what moves in it, and what it became."""
    made = run_path(str(ROOT / "examples" / "gallery" / "animation.py"), run_name="bench")
    for depth in depths:
        yield (
            "ball of the gallery",
            "a rigid ball",
            voxrt.build_animation([made["yard"](number) for number in range(made["COUNT"])], depth=depth),
        )
        for file, animation, moves, (start, stop) in ANIMATED:
            if (ASSETS / file).is_file():
                times = voxrt.frame_times(start, stop, FRAMES)
                built = voxrt.build_animation(ASSETS / file, depth=depth, times=times, animation=animation or None)
                yield f"{Path(file).stem} {animation}".strip(), moves, built


def row(name: str, moves: str, built: voxrt.BuildResult) -> tuple[str, ...]:
    assert built.animation is not None
    words, alone = len(built.octree.words), built.animation.words_alone
    return (
        name,
        moves,
        f"{len(built.animation.frames)}",
        f"{built.octree.depth}",
        f"{alone:,}",
        f"{words:,}",
        f"{words / alone:.2f}",
        f"{sum(built.seconds.values()):.1f}",
    )


def growth(built: voxrt.BuildResult) -> list[int]:
    """Give the words of the first frames together, by their number."""
    assert built.animation is not None
    trees = [built.blob.frame(number).octree for number in range(len(built.animation.frames))]
    return [len(octree.join_frames(trees[:count])[0].words) for count in range(1, len(trees) + 1)]


def plot(found: list[tuple[str, voxrt.BuildResult]], file: Path) -> None:
    """Draw the words against the number of frames, as parts of all frames alone."""
    import matplotlib.pyplot as plt  # noqa: PLC0415 - only for the plot

    figure, axes = plt.subplots(figsize=(7, 4))
    for name, built in found:
        assert built.animation is not None
        counts = np.arange(1, len(built.animation.frames) + 1)
        axes.plot(counts, np.array(growth(built)) / built.animation.words_alone, label=name)
    axes.plot([0, FRAMES], [0, 1], linestyle=":", color="grey", label="alone")
    axes.set_xlabel("frames")
    axes.set_ylabel("words, of all frames alone")
    axes.legend()
    figure.tight_layout()
    figure.savefig(file)


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("--plot", type=Path, help="draw words against frames into this file")
    parser.add_argument("--depth", type=int, nargs="+", default=[7, 8], help="levels of the grids")
    options = parser.parse_args()
    started = time.perf_counter()
    rows, found = [], []
    for name, moves, built in scenes(tuple(options.depth)):
        rows.append(row(name, moves, built))
        print(json.dumps(dict(zip(HEAD, rows[-1], strict=True))), flush=True)
        if built.octree.depth == options.depth[0]:
            found.append((name, built))
    publish("animation.md", ABOUT + table(HEAD, rows, left=2), write=options.write)
    print(f"{time.perf_counter() - started:.0f} s")
    if options.plot:
        plot(found, options.plot)


if __name__ == "__main__":
    main()
