"""Time edits on the static page in Chromium: `make site`, then python bench/web_edit.py.

It needs chromium and chromedriver. Milliseconds from the press of the mouse to the picture on the canvas, by real
clicks, in a window of 1280x800 with four rays per pixel: each tool with brushes of one voxel and of 1/32 of the world,
at places all over the picture. Writes bench/results/web_edit.md.
"""

from __future__ import annotations

import os
import statistics
import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests"))
from fakes.browser import RESTS, Browser, chromium
from fakes.site_server import serving_site

RESULTS = Path(__file__).resolve().parent / "results" / "web_edit.md"
DEPTHS = (7, 10)
TOOLS = {"dig": 4, "build": 4, "paint": 5}  # and a material
PLACES = [(right, down) for down in (-40, 20, 80) for right in (-150, -80, -10, 60)]

WATCH_SCRIPT = """
    const stage = document.querySelector("#stage");
    window.edits = [];
    let pressed = 0;
    addEventListener("pointerdown", () => { pressed = performance.now(); }, true);
    new MutationObserver(() => window.edits.push(performance.now() - pressed))
      .observe(stage, { attributeFilter: ["data-edition"] });
"""


def times(browser: Browser, tool: str, step: int) -> list[float]:
    """Click at all places, and return milliseconds."""
    browser.click(f"[data-tool={tool}]")
    browser.enter("#edit .brush input", step)
    x, y = browser.middle("#picture")
    found = []
    for right, down in PLACES:
        browser.until(RESTS)
        before = browser.run("return window.edits.length")
        browser.mouse([(x + right, y + down)])
        if not browser.until(f"window.edits.length > {before}", 3):
            continue  # nothing is there, or it has this colour
        found.append(browser.run("return window.edits.at(-1)"))
    return found


def main() -> None:
    rows = []
    with serving_site() as address, chromium() as browser:
        for depth in DEPTHS:
            browser.open("about:blank")
            browser.open(f"{address}#scene=courtyard&depth={depth}")
            browser.until(f"document.querySelector('#stage').dataset.scene && {RESTS}")
            browser.run(WATCH_SCRIPT)
            browser.click("#edit-toggle")
            browser.until("document.querySelector('#edit-figures')?.textContent")
            first = browser.run("return document.querySelector('#edit .brush input').valueAsNumber")
            times(browser, "dig", 0)  # compiles
            for tool, material in TOOLS.items():
                browser.click(f"#swatches [data-id='{material}']")
                for step in (0, first):
                    found = times(browser, tool, step)
                    size = browser.run("return document.querySelector('#edit output').textContent")
                    spread = f"{statistics.median(found):.0f} | {max(found):.0f}"
                    rows.append(f"| {2**depth}³ | {tool} | {size} | {len(found)} | {spread} |")
                    print(rows[-1], flush=True)
    head = [
        "# Edits on the static page",
        "",
        "`python bench/web_edit.py`: the courtyard, from the press of the mouse to the picture on the canvas.",
        f"Chromium on {os.cpu_count()} cores; load of the machine {os.getloadavg()[0]:.1f}.",
        "",
        "| world | tool | brush, voxels | clicks | median, ms | longest, ms |",
        "|---|---|--:|--:|--:|--:|",
    ]
    RESULTS.write_text("\n".join([*head, *rows]) + "\n")


if __name__ == "__main__":
    main()
