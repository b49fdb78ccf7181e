"""Time the static page in Chromium: `make site`, then python bench/web_page.py. It needs chromium and chromedriver.

Frames per second of 640x480 by the page's own workers, while the camera orbits; and the seconds from the drop of a
binary glTF file of 5 MB to its first picture at 128³. The quickest counts, since other work on the machine slows
both: twelve frames in a row, and one of three drops. Processor time, which other work hardly changes, is that of all
threads of the page for a frame, beside that of the model in one call.
"""

from __future__ import annotations

import os
import sys
import tempfile
import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import numpy as np
import trimesh

sys.path.append(str(Path(__file__).resolve().parents[1] / "tests"))
from fakes.browser import Browser, chromium

SITE = Path(__file__).resolve().parents[1] / "build" / "site"
SCENES = [("courtyard", 7), ("courtyard", 9), ("planet", 8)]
ROUNDS = 3
FRAMES = 24
WINDOW = 12  # frames: the quickest that follow one another count
TRIANGLES = 280_000  # 5 MB

SETUP_SCRIPT = """
    const [name, depth, frames, done] = arguments;
    (async () => {
      const { Painter } = await import(new URL("painter.js", location));
      const { Builder } = await import(new URL("builder.js", location));
      const { BandPicture } = await import(new URL("band_picture.js", location));
      const { Voxrt } = await import(new URL("voxrt/voxrt.js", location));
      const module = await WebAssembly.compileStreaming(fetch("voxrt/voxrt.wasm"));
      const bytes = new Uint8Array(await (await fetch(`examples/${name}.glb`)).arrayBuffer());
      const builder = new Builder(module);
      const built = await builder.build([{ name: `${name}.glb`, bytes }], { depth, fill: "auto" });
      builder.cancel();
      const shading = { materials: built.materials.map((material) => material.colour) };
      const painter = new Painter(module);
      await painter.load(built, shading);
      const picture = new BandPicture(document.createElement("canvas"));
      const alone = await Voxrt.load(module);
      alone.setMemory(built.words, depth);
      alone.shade(shading);
      const side = 16 * 2 ** depth;
      const cameraOf = (turn) => {
        const [sin, cos] = [Math.sin(turn), Math.cos(turn)].map((part) => part * 8192);
        const position = [side / 2 - 1.4 * side * (sin / 8192), 1.1 * side, side / 2 - 1.4 * side * (cos / 8192)];
        return { position: position.map(Math.round), look: [Math.round(sin), -4000, Math.round(cos)],
                 right: [Math.round(-cos / 700), 0, Math.round(sin / 700)], up: [0, 12, 0] };
      };
      const cameras = Array.from({ length: frames }, (_, i) => cameraOf((6.28 * i) / frames));
      window.benched = { painter, picture, alone, cameras };
      done({ workers: Math.min(navigator.hardwareConcurrency, 8) }); // as painter.js has it
    })().catch((error) => done({ problem: String(error) }));
"""
"""Frames with the page's workers, and with one instance on the thread of the page."""

FRAMES_SCRIPT = """
    const [window_, done] = arguments;
    const { painter, picture, cameras } = window.benched;
    const times = [];
    let sent = 0;
    const ask = () => painter.changeView({ camera: cameras[sent++], size: [640, 480] });
    const finished = ({ detail }) => {
      times.push(performance.now());
      picture.showBands(detail, 1);
      if (sent < cameras.length) ask();
      else if (times.length === cameras.length) {
        painter.removeEventListener("frame", finished);
        const spans = times.slice(window_).map((time, i) => time - times[i]);
        done((1000 * window_) / Math.min(...spans));
      }
    };
    painter.addEventListener("frame", finished);
    ask();
    ask();
"""

MODEL_SCRIPT = """
    const { alone, cameras } = window.benched;
    for (const { position, look, right, up } of cameras)
      alone.with([Int32Array], [[...position, ...look, ...right, ...up]], (at) =>
        alone.checked(alone.wasm.vx_render(at, 640, 480, 0, alone.tileRows(480))));
"""

DROP_SCRIPT = """
    window.measured = null;
    const before = document.querySelector("#stage").dataset.scene;
    addEventListener("drop", () => {
      const start = performance.now();
      const newest = window.voxrt.newest;
      const look = () => {
        if (document.querySelector("#stage").dataset.scene !== before && window.voxrt.newest !== newest)
          window.measured = (performance.now() - start) / 1000;
        else requestAnimationFrame(look);
      };
      look();
    }, { once: true });
"""


def processor_seconds() -> float:
    """Return the processor time that the pages of the browser have had, all threads together."""
    parents, ticks = {}, {}
    for folder in Path("/proc").iterdir():
        try:
            fields = (folder / "stat").read_text().rpartition(")")[2].split()
            renders = b"--type=renderer" in (folder / "cmdline").read_bytes()
        except OSError:  # not a process, or ended
            continue
        parents[folder.name] = fields[1]
        if renders:
            ticks[folder.name] = int(fields[11]) + int(fields[12])
    mine, found = str(os.getpid()), 0
    for number, spent in ticks.items():
        above = number
        while above in parents and above != mine:
            above = parents[above]
        found += spent if above == mine else 0
    return found / os.sysconf("SC_CLK_TCK")


def frame_costs(browser: Browser, name: str, depth: int) -> tuple[int, float, float, float]:
    """Return the workers, frames per second, and processor time per frame: of the page, and of the model alone."""
    found = browser.run_async(SETUP_SCRIPT, name, depth, FRAMES)
    if "problem" in found:
        sys.exit(found["problem"])
    rates, page, model = [], [], []
    for _ in range(ROUNDS + 1):
        start = processor_seconds()
        rates.append(browser.run_async(FRAMES_SCRIPT, WINDOW))
        between = processor_seconds()
        browser.run(MODEL_SCRIPT)
        page.append((between - start) / FRAMES)
        model.append((processor_seconds() - between) / FRAMES)
    browser.run("window.benched.painter.stop()")
    return found["workers"], max(rates), min(page[1:]), min(model[1:])  # the first compiles


def rough_sphere(path: Path) -> None:
    """Write a sphere with hills as a binary glTF file."""
    columns = round((TRIANGLES / 2) ** 0.5)
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, columns), np.linspace(0, np.pi, columns))
    radius = 1 + 0.05 * np.sin(9 * u) * np.sin(7 * v)
    positions = np.stack([radius * np.sin(v) * np.cos(u), radius * np.cos(v), radius * np.sin(v) * np.sin(u)], axis=-1)
    corner = np.arange(columns * (columns - 1)).reshape(columns - 1, columns)[:, :-1].reshape(-1)
    quads = np.stack([corner, corner + 1, corner + columns, corner + 1, corner + columns + 1, corner + columns], axis=1)
    trimesh.Trimesh(positions.reshape(-1, 3), quads.reshape(-1, 3), process=False).export(path)


def seconds_to_picture(browser: Browser, path: Path) -> float:
    browser.run(DROP_SCRIPT)
    browser.drop(*browser.middle("#stage"), [str(path)])
    found = browser.until("window.measured", 60)
    if not isinstance(found, float):
        sys.exit(f"{path.name} was not shown")
    return found


def main() -> None:
    if not SITE.exists():
        sys.exit("build/site is not here: make site")

    class Quiet(SimpleHTTPRequestHandler):
        def log_message(self, *_: object) -> None:
            pass

    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(Quiet, directory=str(SITE)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    shown = "document.querySelector('#stage').getAttribute('aria-busy') === 'false'"
    with chromium() as browser, tempfile.TemporaryDirectory() as folder:
        browser.open(f"http://127.0.0.1:{server.server_port}/")
        browser.until(shown)
        print("| scene, 640x480 | workers | frames per second | processor ms per frame | model alone | ratio |")
        print("|---|--:|--:|--:|--:|--:|")
        for name, depth in SCENES:
            workers, rate, page, model = frame_costs(browser, name, depth)
            costs = f"{page * 1e3:.1f} | {model * 1e3:.1f} | {page / model:.2f}"
            print(f"| {name} {2**depth}³ | {workers} | {rate:.1f} | {costs} |")
        seconds = []
        for number in range(ROUNDS):
            path = Path(folder) / f"sphere{number}.glb"
            rough_sphere(path)
            seconds.append(seconds_to_picture(browser, path))
            browser.until(shown)
        size = path.stat().st_size / 1e6
        print(f"\nDrop to first picture, {size:.1f} MB of {TRIANGLES:,} triangles: {min(seconds):.2f} s")
    print(f"Load of the machine: {os.getloadavg()[0]:.1f}")
    server.shutdown()


if __name__ == "__main__":
    main()
