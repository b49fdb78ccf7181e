"""The acid test of voxelizers: what each tool makes of cases after public issues, judged by its own documentation.

Usage: ``python bench/acid.py [--write]``; ``--tools`` and ``--cases`` choose some. The tools come from PyPI (the group
``acid`` of ``pyproject.toml``) and crates.io into ``build/acid``, a virtual environment of their own. voxrt runs in the
environment of this script, and OpenVDB in Debian's, where its package ``python3-openvdb`` is. Each tool runs in a
process of its own with a time limit per case, so that a crash is a miss. What is right comes from
``acid/checker.py``, in exact fractions. ``--write`` puts the page into ``bench/results/acid.md``, and a picture per
missed case into ``docs/pictures/acid``.
"""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from acid.cases import CASES, Case
from acid.checker import Mesh, Voxel
from acid.picture import picture_of
from acid.tools import EXPLAINED, RULES, TOOLS, Tool, positions, traits_of
from report import ROOT, machine, options_of, publish, table

from voxrt.voxelize.rules import RULES as RULES_OF_VOXRT

ENVIRONMENT = ROOT / "build" / "acid"
PICTURES = ROOT / "docs" / "pictures" / "acid"
PYTHONS = {"voxrt-build": Path(sys.executable), "python3-openvdb": Path("/usr/bin/python3")}
RUNNER = ROOT / "bench" / "acid" / "run_tool.py"


@dataclass(frozen=True)
class Answer:
    """What a tool made of a case: voxels, or why there are none."""

    voxels: frozenset[Voxel] = frozenset()
    error: str = ""


def install() -> None:
    """Make the environment of the tools, where it is not there."""
    done = ENVIRONMENT / ".installed"
    if done.exists() and done.stat().st_mtime > (ROOT / "pyproject.toml").stat().st_mtime:
        return
    subprocess.run([sys.executable, "-m", "venv", ENVIRONMENT], check=True)
    pip = [ENVIRONMENT / "bin" / "python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
    subprocess.run([*pip, "--upgrade", "pip>=25.1"], check=True)
    subprocess.run([*pip, "--group", f"{ROOT / 'pyproject.toml'}:acid"], check=True)
    if cargo := shutil.which("cargo"):
        subprocess.run([cargo, "install", "--quiet", "voxquant", "--root", ENVIRONMENT], check=True)
    done.touch()


def absent() -> set[str]:
    """Return the tools that no Python registry serves and that are not here, and rules that voxrt lacks."""
    missing = {f"voxrt {rule}" for rule in {"touch", "centre", "half"} - set(RULES_OF_VOXRT)}
    if not (ENVIRONMENT / "bin" / "voxquant").exists():
        missing.add("voxquant")
    python = PYTHONS["python3-openvdb"]
    if (
        not python.exists()
        or subprocess.run([python, "-c", "import pyopenvdb"], capture_output=True, check=False).returncode
    ):
        missing.add("OpenVDB")
    return missing


def save_cases(file: Path, cases: list[Case]) -> None:
    arrays: dict[str, object] = {"count": len(cases)}
    for index, case in enumerate(cases):
        corners = positions(case).reshape(-1, 3)
        vertices, faces = np.unique(corners, axis=0, return_inverse=True)
        arrays |= {f"vertices{index}": vertices, f"faces{index}": faces.reshape(-1, 3)}
        arrays |= {f"low{index}": np.array(case.origin, float), f"side{index}": 2**case.depth}
    np.savez(file, **arrays)


def run(tool: Tool, file: Path, count: int, seconds: float) -> tuple[str, dict[int, Answer]]:
    """Run a tool on all cases: its version, and its answers. After a crash it goes on with the next case."""
    python = PYTHONS.get(tool.package, ENVIRONMENT / "bin" / "python")
    answers: dict[int, Answer] = {}
    version = ""
    while len(answers) < count:
        out = file.with_name("out.jsonl")
        out.write_text("")
        command = [str(python), str(RUNNER), tool.name, tool.package, str(file), str(out), str(len(answers))]
        process = subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, start_new_session=True, cwd=file.parent
        )
        size, since = 0, time.monotonic()
        while process.poll() is None and time.monotonic() - since < (seconds if size else 120):
            time.sleep(0.05)
            if out.stat().st_size != size:
                size, since = out.stat().st_size, time.monotonic()
        if late := process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        errors = process.communicate()[1].decode("utf-8", "replace").strip().splitlines()
        for line in map(json.loads, out.read_text().splitlines()):
            version = line.get("version", version)
            if "voxels" in line:
                answers[line["case"]] = Answer(frozenset(map(tuple, line["voxels"])))
            elif "error" in line:
                answers[line["case"]] = Answer(error=line["error"])
        if len(answers) < count:
            word = signal.Signals(-process.returncode).name if process.returncode < 0 else (errors or ["?"])[-1]
            answers[len(answers)] = Answer(error=f"more than {seconds:g} s" if late else word)
    return version, answers


def verdict(answer: Answer, required: set[Voxel], allowed: set[Voxel], side: int, *, bounded: bool) -> str:
    """Say what is wrong with an answer; nothing where it is right. Voxels outside of the grid count if `bounded`."""
    if answer.error:
        return answer.error
    extra = sum(bounded or all(0 <= v < side for v in voxel) for voxel in answer.voxels - allowed)
    missing = len(required - answer.voxels)
    return ", ".join(f"{n} {word}" for n, word in ((missing, "missing"), (extra, "extra")) if n)


def page_of(cases: list[Case], tools: list[Tool], versions: dict[str, str], found: dict[str, dict[int, str]]) -> str:
    """Give the page: the tools, the cases that some of them miss, with pictures, and the others."""
    rows = []
    for tool in tools:
        judged = found[tool.name]
        wrong = sum(1 for word in judged.values() if word)
        counts = (f"{len(judged)}", f"{len(judged) - wrong}", f"{wrong}")
        rows.append((tool.name, versions[tool.name], tool.rule, *counts, tool.documentation))
    head = ("tool", "version", "rule", "judged", "right", "missed", "its documentation")
    text = f"# Acid test\n\n{machine()}; {len(cases)} cases, by `bench/acid.py`.\n\n{table(head, rows)}\n## Rules\n\n"
    used = dict.fromkeys(tool.rule for tool in tools)
    text += "".join(f"- **{rule}**: {EXPLAINED[rule]}\n" for rule in used)
    missed = [i for i, _ in enumerate(cases) if any(found[tool.name].get(i) for tool in tools)]
    lines = []
    for index in missed:
        words = [f"{t.name}: {found[t.name][index]}" for t in tools if found[t.name].get(index)]
        picture = f"![{cases[index].name}](../../docs/pictures/acid/{file_name(cases[index])})"
        lines.append((picture, f"{cases[index].name}<br>{link(cases[index])}", "<br>".join(words)))
    text += f"\n## Missed cases\n\n{table(('case', 'after', 'misses: voxels'), lines)}"
    rest = [f"{case.name} ({link(case)})" for i, case in enumerate(cases) if i not in missed]
    return text + (f"\n## Cases that no tool misses\n\n{', '.join(rest)}.\n" if rest else "")


def link(case: Case) -> str:
    repository, number = case.issue.split("#")
    return f"[{case.issue}](https://github.com/{repository}/issues/{number})"


def file_name(case: Case) -> str:
    kept = "".join(c if c.isascii() and c.isalnum() else "-" for c in case.name.lower())
    return "-".join(word for word in kept.split("-") if word) + ".svg"


def main() -> None:
    parser = options_of(__doc__)
    parser.add_argument("--seconds", type=float, default=20, help="time limit per case")
    parser.add_argument("--tools", nargs="*", help="of those in the table")
    parser.add_argument("--cases", nargs="*", help="names of cases")
    options = parser.parse_args()
    install()
    cases = [case for case in CASES if not options.cases or case.name in options.cases]
    tools = [tool for tool in TOOLS if not options.tools or tool.name in options.tools]
    tools = [tool for tool in tools if tool.name not in absent()]
    meshes = [Mesh(case.surface, 2**case.depth) for case in cases]
    traits = [traits_of(case) for case in cases]
    rights: dict[tuple[str, int], tuple[set[Voxel], set[Voxel]]] = {}
    versions: dict[str, str] = {}
    found: dict[str, dict[int, str]] = {}
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "cases.npz"
        save_cases(file, cases)
        for tool in tools:
            start = time.monotonic()
            versions[tool.name], answers = run(tool, file, len(cases), options.seconds)
            found[tool.name] = {}
            for index, answer in answers.items():
                if traits[index] & tool.exclusions:
                    continue
                side = 2 ** cases[index].depth
                if (tool.rule, index) not in rights:
                    of_surface = "surface" in tool.rule
                    mesh = Mesh(cases[index].triangles, side, sheets=True) if of_surface else meshes[index]
                    rights[tool.rule, index] = RULES[tool.rule](mesh)
                right = rights[tool.rule, index]
                found[tool.name][index] = verdict(answer, *right, side, bounded=tool.bounded)
            wrong = {cases[i].name: word for i, word in found[tool.name].items() if word}
            spent = time.monotonic() - start
            print(f"{tool.name} {versions[tool.name]}, {spent:.0f} s: {len(wrong)} missed {wrong}", file=sys.stderr)
    publish("acid.md", page_of(cases, tools, versions, found), write=options.write)
    if options.write:
        PICTURES.mkdir(exist_ok=True)
        for old in PICTURES.glob("*.svg"):
            old.unlink()
        for index, case in enumerate(cases):
            if any(words.get(index) for words in found.values()):
                (PICTURES / file_name(case)).write_text(picture_of(case), encoding="utf-8")


if __name__ == "__main__":
    main()
