"""Damaged USD or STEP files, as many as you like, all read by this one process: it must live to the end. From the root,

    python tests/fuzz/isolated.py usd --files 5000 --seeds ../shared/assets/usd

Seeds are an example, USD as text and as binary, and small files below ``--seeds``. Each damaged file has a few bytes
changed, a stretch removed, or one repeated. It is read, or refused in one line. What was seen is printed at the end:
scenes, refusals by kind, and the longest time. Another kind of error ends the campaign and names the file.
"""

from __future__ import annotations

import argparse
import collections
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from oracles.step_writer import step_of_a_box

from voxrt import voxelize
from voxrt.voxelize.formats.reader_process.limits import Limits
from voxrt.voxelize.formats.step.isolated import load_step
from voxrt.voxelize.formats.usd.isolated import read_isolated

ROOT = Path(__file__).resolve().parents[2]
_LARGEST_SEED = 64 << 10
_COUNTS = (0, 1, 255, 1 << 31, 1 << 40, (1 << 64) - 1)
_LIMITS = Limits(memory=1 << 30, most_memory=1 << 30, seconds=10)
_TO_BINARY = "import sys; from pxr import Sdf, Usd; Sdf.Layer.FindOrOpen(sys.argv[1]).Export(sys.argv[2])"


def step_seeds(folder: Path | None, _: Path) -> list[tuple[str, bytes]]:
    """The suffix and the bytes of each STEP file to damage."""
    files = (
        [] if folder is None else [one for one in sorted(folder.rglob("*.st*p")) if one.stat().st_size <= _LARGEST_SEED]
    )
    return [(".step", step_of_a_box((1, 2, 4)).encode()), *((path.suffix, path.read_bytes()) for path in files)]


def usd_seeds(folder: Path | None, into: Path) -> list[tuple[str, bytes]]:
    """The suffix and the bytes of each USD file to damage."""
    files = [ROOT / "examples" / "dog.usda"]
    if folder is not None:
        files += [path for path in sorted(folder.rglob("*.usd*")) if path.stat().st_size <= _LARGEST_SEED]
    found = [(path.suffix, path.read_bytes()) for path in files]
    for number, path in enumerate(files):
        binary = into / f"seed{number}.usdc"
        if path.suffix == ".usda":  # by a process of its own: this one must not import usd-core
            subprocess.run([sys.executable, "-c", _TO_BINARY, path, binary], check=False, capture_output=True)
            if binary.exists():
                found.append((binary.suffix, binary.read_bytes()))
    return found


READERS = {"usd": (usd_seeds, read_isolated), "step": (step_seeds, load_step)}
"""The files to damage, and what reads them."""


def damaged(data: bytes, random: np.random.Generator) -> bytes:
    """A copy with one to four faults."""
    made = bytearray(data)
    for _ in range(int(random.integers(1, 5))):
        at = int(random.integers(len(made)))
        kind = int(random.integers(6))
        if kind < 3:
            made[at] = int(random.integers(256))
        elif kind == 3:
            made[at : at + 8] = _COUNTS[int(random.integers(len(_COUNTS)))].to_bytes(8, "little")
        elif kind == 4:
            del made[at : at + int(random.integers(1, 64))]
        else:
            made[at:at] = made[at : at + int(random.integers(1, 64))]
        made = made or bytearray(b"\0")
    return bytes(made)


def main() -> None:
    """Run the campaign."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("reader", choices=READERS)
    parser.add_argument("--files", type=int, default=5000)
    parser.add_argument("--seconds", type=float, default=float("inf"), help="stop after so long")
    parser.add_argument("--seeds", type=Path)
    parser.add_argument("--seed", type=int, default=1, help="of the random numbers")
    arguments = parser.parse_args()
    seeds, read = READERS[arguments.reader]
    random = np.random.default_rng(arguments.seed)
    seen: collections.Counter[str] = collections.Counter()
    longest, start = 0.0, time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        sources = seeds(arguments.seeds, Path(folder))
        for _ in range(arguments.files):
            suffix, data = sources[int(random.integers(len(sources)))]
            path = Path(folder, f"damaged{suffix}")
            path.write_bytes(damaged(data, random))
            begun = time.monotonic()
            try:
                read(path, limits=_LIMITS)
                seen["read"] += 1
            except (voxelize.AssetError, voxelize.DoesNotFitError) as error:
                assert "\n" not in str(error), f"{path}: {error}"  # noqa: PT017
                crashed = re.search(r"crashed .*\((\w+)\)|(takes more than|needs more memory)", str(error))
                seen[crashed[1] or crashed[2] if crashed else "refused"] += 1
            longest = max(longest, time.monotonic() - begun)
            if time.monotonic() - start > arguments.seconds:
                break
    took = time.monotonic() - start
    kinds = ", ".join(f"{kind}: {count}" for kind, count in seen.most_common())
    sys.stdout.write(
        f"{seen.total()} files of {len(sources)} seeds in {took:.0f} s, 0 dead parents\n"
        f"{kinds}; the longest {longest:.1f} s\n"
    )


if __name__ == "__main__":
    main()
