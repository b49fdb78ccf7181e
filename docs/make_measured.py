"""Write the pages of measured tables, docs/measured/, one per file of bench/results; ``docs/conf.py`` runs it.

The tables stand in ``bench/results`` as the benchmarks write them. A page adds a title.
"""

from __future__ import annotations

from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
RESULTS = REPOSITORY / "bench" / "results"
TITLES = {
    "budget": "Budget",
    "coverage": "Coverage",
    "demo": "Demo",
    "interior": "Interior",
    "mutation": "Mutation",
    "peers": "Other voxelizers",
    "rtl": "Cycles per pixel",
    "soak": "Soak",
}
"""Titles by the file's name. A file that is not listed keeps its own title, or has its name as one."""


def page(path: Path) -> str:
    """Give the text of the page of one file of results."""
    text = path.read_text(encoding="utf-8")
    text = text.replace("(../../docs/", "(../")  # pictures, as seen from the page
    own, rest = text[2:].split("\n", 1) if text.startswith("# ") else (path.stem.capitalize(), text)
    title = TITLES.get(path.stem, own)
    return f"# {title}\n\nThe file `bench/results/{path.name}`, as its benchmark wrote it.\n\n{rest.lstrip()}"


def cycles_table() -> str:
    """Give cycles per pixel by scene and configuration: the plain frames of 256 x 256 pixels of ``rtl.md``."""
    text = (RESULTS / "rtl.md").read_text(encoding="utf-8").partition("256x256 pixels.")[2]
    table = [line for line in text.partition("640x480")[0].splitlines() if line.startswith("|")]
    heads, _, *rows = ([cell.strip() for cell in line.strip("|").split("|")] for line in table)
    entries = [dict(zip(heads, row, strict=True)) for row in rows]
    words, cycles = (next(head for head in heads if head.startswith(name)) for name in ("words", "cycles"))
    plain = [entry for entry in entries if entry["frame"] == "plain" and not entry["configuration"].startswith("lit")]
    columns = sorted({(int(entry["lanes"]), entry["configuration"]) for entry in plain})
    names = [f"`{name}`, {lanes} lane{'s' * (lanes > 1)}" for lanes, name in columns]
    lines = [f"| scene | words per ray | {' | '.join(names)} |", "|---|--:|" + "--:|" * len(names)]
    for scene in dict.fromkeys(entry["scene"] for entry in plain):
        here = {entry["configuration"]: entry for entry in plain if entry["scene"] == scene}
        counts = [f"{float(here[name][cycles]):.2f}" for _, name in columns]
        lines.append(f"| {scene} | {float(here[columns[0][1]][words]):.1f} | {' | '.join(counts)} |")
    return "\n".join(lines) + "\n"


def write(folder: Path) -> list[str]:
    """Write every page, and give their names."""
    folder.mkdir(exist_ok=True)
    (folder / "cycles.txt").write_text(cycles_table(), encoding="utf-8")
    sources = sorted(RESULTS.glob("*.md"))
    for old in {path.name for path in folder.glob("*.md")} - {path.name for path in sources}:
        (folder / old).unlink()
    for path in sources:
        text, target = page(path), folder / path.name
        if not target.exists() or target.read_text(encoding="utf-8") != text:
            target.write_text(text, encoding="utf-8")
    return [path.stem for path in sources]
