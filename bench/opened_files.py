"""Which files a build of an asset opens: ``python bench/opened_files.py [--write]``, on Linux with strace.

Each shared asset is built by the installed command, in a folder of its own, while strace lists what all its processes
open. A file is outside where it is neither in the asset's folder, nor in that of the output, nor of the system, of
Python or of voxrt.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections import Counter
from pathlib import Path

from report import ASSETS, machine, options_of, publish, table

from voxrt.voxelize.assets import SUFFIXES

OPENED = re.compile(r'(?:open|openat|openat2)\((?:(?:AT_FDCWD|\d+)<([^>]*)>, )?"((?:[^"\\]|\\.)*)"')
COMMAND = Path(sys.executable).with_name("voxrt-build")


def system_folders() -> tuple[Path, ...]:
    """Folders whose files belong to the system, to Python and to what is installed."""
    python = (sys.prefix, sys.base_prefix, *sysconfig.get_paths().values())
    return tuple(map(Path, ("/dev", "/etc", "/lib", "/lib64", "/proc", "/sys", "/usr", "/var/cache", *python)))


def opened_outside(asset: Path, system: tuple[Path, ...]) -> set[Path]:
    """Build an asset; return what was opened elsewhere."""
    with tempfile.TemporaryDirectory() as folder:
        log = Path(folder, "strace")
        tracer = ["strace", "-f", "-qq", "-z", "-y", "-e", "trace=open,openat,openat2", "-o", str(log)]
        build = [str(COMMAND), str(asset), "-o", folder, "--depth", "5", "--allow-empty"]
        subprocess.run([*tracer, *build], cwd=folder, capture_output=True, check=False, timeout=600)
        paths = {Path(base, path) for base, path in OPENED.findall(log.read_text(errors="replace"))}
    inside = (asset.parent, Path(folder), Path(tempfile.gettempdir()), *system)
    return {path for path in map(Path.resolve, paths) if not any(path.is_relative_to(one) for one in inside)}


def main() -> None:
    arguments = options_of(__doc__).parse_args()
    if shutil.which("strace") is None:
        sys.exit("strace is not here: apt install strace")
    assets = sorted(path for path in ASSETS.rglob("*") if path.suffix.lower() in SUFFIXES and path.is_file())
    system = system_folders()
    counts: Counter[str] = Counter()
    outside: Counter[str] = Counter()
    for asset in assets:
        found = opened_outside(asset, system)
        counts[asset.suffix.lower()] += 1
        outside[asset.suffix.lower()] += len(found)
        for path in sorted(found):
            print(f"{asset.relative_to(ASSETS)}: opened {path}")
    rows = [(suffix, str(count), str(outside[suffix])) for suffix, count in sorted(counts.items())]
    rows.append(("all", str(counts.total()), str(outside.total())))
    text = f"{machine()}; by `bench/opened_files.py`.\n\n{table(('format', 'assets', 'files opened outside'), rows, 1)}"
    publish("opened_files.md", f"# Files that builds open\n\n{text}", write=arguments.write)


if __name__ == "__main__":
    main()
