"""Write the pages of measured tables, docs/measured/, one per file of bench/results; ``docs/conf.py`` runs it.

The tables stand in ``bench/results`` as the benchmarks write them. A page gives each a title, where it has none, and
says which benchmark writes it.
"""

from __future__ import annotations

from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
RESULTS = REPOSITORY / "bench" / "results"
TITLES = {"rtl": "Cycles per pixel"}  # where the file's name is no title


def page(path: Path) -> str:
    """Give the text of the page of one file of results."""
    text = path.read_text(encoding="utf-8")
    if not text.startswith("# "):
        text = f"# {TITLES.get(path.stem, path.stem.capitalize())}\n\n{text}"
    head, _, rest = text.partition("\n")
    return f"{head}\n\nThe file `bench/results/{path.name}`, as its benchmark wrote it.\n\n{rest.lstrip()}"


def write(folder: Path) -> list[str]:
    """Write every page, and give their names."""
    folder.mkdir(exist_ok=True)
    sources = sorted(RESULTS.glob("*.md"))
    for old in {path.name for path in folder.glob("*.md")} - {path.name for path in sources}:
        (folder / old).unlink()
    for path in sources:
        text, target = page(path), folder / path.name
        if not target.exists() or target.read_text(encoding="utf-8") != text:
            target.write_text(text, encoding="utf-8")
    return [path.stem for path in sources]
