"""Coverage-guided fuzzing of a reader, with atheris (libFuzzer): from the repository's root, in a venv of its own,

    python3.11 -m venv /tmp/fuzz && /tmp/fuzz/bin/pip install atheris .
    nice /tmp/fuzz/bin/python tests/fuzz/run.py obj --seconds 300 --seeds ../shared/assets

Readers are those of ``readers.py``. Files of at most 16 KiB below ``--seeds`` with a reader's suffix join its own
seeds; what libFuzzer keeps stays in ``build/fuzz/READER`` from one run to the next. Anything but a scene or a refusal
in one line is a finding: of each place that raised one, the smallest input is left in ``build/fuzz``. So is the input
that takes more than ten seconds or more than 3 GiB of memory, which ends the run. A finding becomes a small test.
"""

from __future__ import annotations

import argparse
import resource
import sys
import tempfile
import traceback
from pathlib import Path

import atheris

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

with atheris.instrument_imports(include=["voxrt"]):
    from fuzz.readers import READERS

    import voxrt.voxelize.authoring.scene_toml

    # Those that load() would import after instrumenting is over.
    import voxrt.voxelize.formats.dae.load
    import voxrt.voxelize.formats.gltf
    import voxrt.voxelize.formats.obj
    import voxrt.voxelize.formats.off
    import voxrt.voxelize.formats.ply
    import voxrt.voxelize.formats.points
    import voxrt.voxelize.formats.stl.load
    import voxrt.voxelize.formats.threemf.load
    import voxrt.voxelize.formats.vox.scene  # noqa: F401

_MEMORY = 3 << 30
_LARGEST_SEED = 16 << 10


def main() -> None:
    """Fuzz one reader."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("reader", choices=READERS)
    parser.add_argument("--seconds", type=int, default=300)
    parser.add_argument("--seeds", type=Path)
    arguments = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_AS, (_MEMORY, _MEMORY))
    reader = READERS[arguments.reader]
    corpus = ROOT / "build" / "fuzz" / arguments.reader
    corpus.mkdir(parents=True, exist_ok=True)
    seeds = list(reader.seeds)
    if arguments.seeds:
        files = (path for path in sorted(arguments.seeds.rglob("*")) if path.suffix.lower() in reader.suffixes)
        seeds += [path.read_bytes() for path in files if path.stat().st_size <= _LARGEST_SEED]
    for number, seed in enumerate(seeds):
        (corpus / f"seed-{number}").write_bytes(seed)
    words = corpus.parent / f"{arguments.reader}.dict"
    words.write_text("".join('"' + "".join(f"\\x{byte:02x}" for byte in token) + '"\n' for token in reader.tokens))
    found: dict[str, int] = {}

    def one(data: bytes) -> None:
        try:
            reader.run(Path(folder), data)
        except Exception as error:  # noqa: BLE001 -- whatever it is, it is a finding
            frames = traceback.extract_tb(error.__traceback__)
            frame = ([one for one in frames if "voxrt" in one.filename] or frames)[-1]
            name = f"{arguments.reader}-{type(error).__name__}-{Path(frame.filename).stem}-{frame.lineno}"
            if len(data) < found.get(name, sys.maxsize):
                if name not in found:
                    sys.stderr.write(f"FOUND {name}: {error}\n")
                found[name] = len(data)
                (corpus.parent / name).write_bytes(data)

    with tempfile.TemporaryDirectory() as folder:
        atheris.Setup(
            [
                sys.argv[0],
                str(corpus),
                *([f"-dict={words}"] if reader.tokens else []),
                f"-artifact_prefix={corpus.parent}/{arguments.reader}-",
                f"-max_total_time={arguments.seconds}",
                *("-timeout=10", "-rss_limit_mb=3000", "-max_len=16384", "-print_final_stats=1"),
            ],
            one,
        )
        atheris.Fuzz()


if __name__ == "__main__":
    main()
