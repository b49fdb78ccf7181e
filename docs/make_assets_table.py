"""Write docs/assets.md: what becomes of each of the development assets.

The page itself lists them: a new asset is added as a row with its name alone. They stand in ``../shared/assets`` beside
the repository, or where ``VOXRT_ASSETS`` says; ``make assets`` has their origins. Each asset has a process of its own,
bounded in memory and in time, so that none can take the others down with it. Run without arguments to write the page;
``--print`` prints it instead, for the tests to compare.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import re
import resource
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING

import voxrt
from voxrt import export, octree, voxelize

if TYPE_CHECKING:
    from collections.abc import Iterable
    from multiprocessing.connection import Connection

REPOSITORY = Path(__file__).resolve().parents[1]
ROOT = Path(os.environ.get("VOXRT_ASSETS", REPOSITORY.parent / "shared" / "assets"))
PAGE = REPOSITORY / "docs" / "assets.md"

DEPTH = 6
MEMORY = 6 << 30
SECONDS = 240
PROCESSES = 2

LISTED = re.compile(r"\| `([^`]+/[^`]+)` \|")

HEAD = """# What becomes of the development assets

One row for each of the {total} third-party files that voxrt is developed with: {built} are built and {refused} are
refused, each with the one line that `voxrt build` says. `docs/make_assets_table.py` writes this page and a test
compares all of it. Meshes are built at depth {depth}; MagicaVoxel scenes (`.vox`), which `voxrt convert` reads, bring
their own depth and have no triangles. *Triangles* counts every instance. *Materials* are those of the loaded scene.
Warnings are given by kind, with how many times each was met. Assets may name files outside their folder here, as
`--allow-outside` has it, for USD stages often share layers that way. Problems of USD files are told in the words of
usd-core {usd}.

| asset | triangles | materials | solid voxels | warnings | outcome |
|---|--:|--:|--:|---|---|
"""


@dataclass(frozen=True, slots=True)
class Row:
    """What became of one asset; what it never came to is empty."""

    asset: str
    triangles: str = ""
    materials: str = ""
    solid_voxels: str = ""
    warnings: str = ""
    outcome: str = ""

    def __str__(self) -> str:
        cells = (self.triangles, self.materials, self.solid_voxels, self.warnings, self.outcome)
        return " | ".join((f"| `{self.asset}`", *cells)) + " |\n"


def listed_assets() -> list[str]:
    """Give the assets that the page has, in its order."""
    return [found[1] for line in PAGE.read_text(encoding="utf-8").splitlines() if (found := LISTED.match(line))]


def examine(root: Path, asset: str) -> Row:
    """Load and build an asset, and tell what was said of it."""
    row = Row(asset)
    try:
        if asset.endswith(".vox"):
            blob, warnings = export.read_any(root / asset)
            row = replace(row, materials=_count(len(blob.rom.materials) - 1))
            solid_voxels = octree.census(blob.rom.octree).solid_voxels
        else:
            scene = voxelize.load(root / asset, allow_outside=True)
            triangles = sum(len(thing.mesh.triangles) for thing in scene.objects)
            row = replace(
                row,
                triangles=_count(triangles),
                materials=_count(len(scene.materials) - 1),
                warnings=_by_kind(scene.warnings),
            )
            result = voxrt.build(scene, depth=DEPTH, threads=1)
            solid_voxels, warnings = result.solid_voxels, result.warnings
        return replace(row, solid_voxels=_count(solid_voxels), warnings=_by_kind(warnings), outcome="built")
    except (voxelize.AssetError, voxelize.DoesNotFitError, octree.RomError) as error:
        return replace(row, outcome=f"refused: {_cell(str(error), root, asset)}")
    except MemoryError:
        return replace(row, outcome="FAILED: out of memory")
    except Exception as error:  # noqa: BLE001 - a fault of voxrt, whatever it is, belongs into the table
        return replace(row, outcome=f"FAILED: {type(error).__name__}: {_cell(str(error), root, asset)}")


def _count(number: int) -> str:
    return f"{number:,}"


def _by_kind(warnings: Iterable[voxelize.SceneWarning]) -> str:
    counts: Counter[str] = Counter()
    for warning in warnings:
        counts[warning.kind] += warning.count
    return ", ".join(f"{kind} {count:,}" for kind, count in sorted(counts.items()))


def _cell(message: str, root: Path, asset: str) -> str:
    text = message.replace(f"{root / asset}: ", "").replace(f"{root}/", "").replace("`", "'")
    return text.replace("|", "\\|").replace("<", "&lt;").replace("*", "\\*").replace("\n", " ")


def _answer(answers: Connection, root: Path, asset: str) -> None:
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    answers.send(examine(root, asset))


def _examine_apart(context: multiprocessing.context.ForkServerContext, asset: str) -> Row:
    answers, end = context.Pipe(duplex=False)
    process = context.Process(target=_answer, args=(end, ROOT, asset))
    process.start()
    end.close()
    try:
        return answers.recv() if answers.poll(SECONDS) else Row(asset, outcome=f"FAILED: not done in {SECONDS} seconds")
    except EOFError:
        process.join()
        return Row(asset, outcome=f"FAILED: its process ended with {process.exitcode}")
    finally:
        process.kill()
        process.join()


def examine_all() -> list[Row]:
    """Examine every listed asset, each in a process of its own."""
    context = multiprocessing.get_context("forkserver")
    # What every process needs is imported once, before they part.
    formats = ("gltf.load", "obj.load", "ply.load", "stl.load", "usd.isolated")
    context.set_forkserver_preload(["voxrt.building.pipeline", *(f"voxrt.voxelize.formats.{name}" for name in formats)])
    with ThreadPoolExecutor(PROCESSES) as pool:
        return list(pool.map(lambda asset: _examine_apart(context, asset), listed_assets()))


def page(rows: list[Row]) -> str:
    """Give the whole page."""
    built = sum(row.outcome == "built" for row in rows)
    refused = sum(row.outcome.startswith("refused") for row in rows)
    head = HEAD.format(total=len(rows), built=built, refused=refused, depth=DEPTH, usd=version("usd-core"))
    return head + "".join(map(str, rows))


def main() -> None:
    """Write the page, or print it."""
    parser = argparse.ArgumentParser(description="Write docs/assets.md.")
    parser.add_argument("--print", action="store_true", help="print the page instead")
    only_print = parser.parse_args().print
    text = page(examine_all())
    if only_print:
        print(text, end="")  # noqa: T201 - what was asked for
    else:
        PAGE.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
