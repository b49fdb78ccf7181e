"""List the public files that tests read and that are missing or changed: ``make assets``.

``assets.tsv`` has the origin of each: repository, commit and path on GitHub, and its SHA-256. Files stand below the
folder that ``VOXRT_ASSETS`` names, or else ``../shared/assets`` beside the checkout. Nothing is downloaded.
"""

from __future__ import annotations

import csv
import hashlib
import os
from pathlib import Path
from urllib.parse import quote

TESTS = Path(__file__).resolve().parent
ROOT = Path(os.environ.get("VOXRT_ASSETS", TESTS.parents[1] / "shared" / "assets"))


def main() -> None:
    with (TESTS / "assets.tsv").open(encoding="utf-8", newline="") as file:
        origins = list(csv.DictReader(file, delimiter="\t"))
    missing = 0
    for origin in origins:
        path = ROOT / origin["file"]
        if path.is_file() and hashlib.sha256(path.read_bytes()).hexdigest() == origin["sha256"]:
            continue
        missing += 1
        url = f"https://raw.githubusercontent.com/{origin['repository']}/{origin['commit']}/{quote(origin['path'])}"
        print(f"{'changed' if path.is_file() else 'missing'}\t{origin['file']}\t{url}\t{origin['sha256']}")
    print(f"{missing} of {len(origins)} files are missing or changed below {ROOT}")


if __name__ == "__main__":
    main()
