"""Put the static page together: build/site, which any web server can serve, from any path.

It holds the page (web/page), what it shares with the page of the server (serve/page), the npm package (web/package)
with the modules of web/build_voxrt.py and web/build_hardware.py, the loaders of three.js from npm without their
manuals, and example scenes. Nothing is bundled but voxrt-view.js, the custom element; the core of three.js is minified.

    npm ci --prefix web                # three.js, esbuild and TypeScript, as web/package-lock.json pins them
    python web/make_site.py            # needs the package voxrt, and the group `web` of pyproject.toml
    python -m http.server -d build/site
"""

from __future__ import annotations

import hashlib
import json
import re
import shutil
import subprocess
import sys
import zlib
from pathlib import Path

from board_files import add_boards
from build_hardware import build_hardware
from build_voxrt import build, build_edit, build_view
from compiler import BUILD, ROOT

import voxrt
from voxrt.octree import BOARDS

SITE = ROOT / "build" / "site"
PACKAGE = BUILD / "package"

MODULES = ROOT / "web" / "node_modules"
LOADERS = ("GLTFLoader", "OBJLoader", "MTLLoader", "STLLoader", "PLYLoader", "USDLoader")
ADDONS = (*(f"loaders/{name}.js" for name in LOADERS), "libs/meshopt_decoder.module.js")
MANUAL = re.compile(r"^[ \t]*/\*\*\n(?:[ \t]*\*(?!/).*\n)*[ \t]*\*/\n", re.MULTILINE)
TYPES = re.compile(r"^[ \t]*/\*\*(?:(?!\*/)[\s\S])*\*/\n|/\*\*(?:(?!\*/)[\s\S])*\*/ ?", re.MULTILINE)
IMPORT = re.compile(r"""(from\s+)(['"])([^'"]+)\2""")

SHARED = (
    "aim.js", "brush.js", "camera.js", "camera_text.js", "controls.css", "copy_address.js", "crc32.js", "drop.js",
    "edit.css", "edit_bar.js", "edit_controls.js", "edit_pointer.js", "elements.js", "events.js", "figures.js",
    "flight.js", "frame_requests.js", "gestures.js", "glide.js", "icon.svg", "light.js", "navigation.js", "notices.js",
    "picture.js", "pilot.js", "projection.js", "resolution.js", "save.js", "solids.js", "style.css", "tools.js",
    "vectors.js", "viewpoint.js", "views.js", "walk.js", "walker.js",
)  # fmt: skip
"""Files of the server's page."""

EXAMPLES = {
    "courtyard": ("Courtyard", ("courtyard.glb",)),
    "planet": ("Planet", ("planet.glb",)),
    "house": ("House", ("house.obj", "house.mtl")),
    "dog": ("Dog", ("dog.mem", "dog.json")),
}
"""Name: title and files. The dog's boxes are physics colliders, which only voxrt reads: its memory is built here."""


def main() -> None:
    """Build the modules, and put the site together anew."""
    make_site(build(), build_edit(), build_hardware("tiny"))
    files = [path for path in SITE.rglob("*") if path.is_file()]
    print(f"{SITE.relative_to(ROOT)}: {len(files)} files, {sum(path.stat().st_size for path in files):,} bytes")


def make_site(*modules: Path) -> None:
    """Put the site together in a folder of its own, then in place of the old one."""
    if not MODULES.exists():
        sys.exit("web/make_site.py takes three.js from web/node_modules, which is not here: npm ci --prefix web")
    made = BUILD / "site"
    shutil.rmtree(made, ignore_errors=True)
    shutil.copytree(ROOT / "web" / "page", made)
    for name in SHARED:
        shutil.copyfile(ROOT / "serve" / "page" / name, made / name)
    make_package(modules)
    (made / "voxrt").mkdir()
    for script in (*PACKAGE.glob("*.js"), ROOT / "octree" / "words.js", *modules):
        shutil.copyfile(script, made / "voxrt" / script.name)
    for script in made.rglob("*.js"):
        script.write_text(
            TYPES.sub("", script.read_text(encoding="utf-8")), encoding="utf-8"
        )  # no types, as for three.js
    shutil.copyfile(ROOT / "LICENSE", made / "LICENSE")
    bundle_view(made)
    (made / "package.json").write_text('{"private": true, "type": "module"}\n')  # for Node
    add_three(made / "three")
    add_examples(made / "examples")
    designs = add_boards(made / "boards")
    for name in set(designs.values()):
        shutil.copyfile(build_hardware(name), made / "boards" / f"{name}.wasm")
    known = {
        "boards": BOARDS,
        "designs": sorted(designs),
        "examples": {name: {"title": title, "files": files} for name, (title, files) in EXAMPLES.items()},
    }
    (made / "site.json").write_text(json.dumps(known, indent=2) + "\n")
    bundle_offline(made)
    shutil.rmtree(SITE, ignore_errors=True)
    made.rename(SITE)


def make_package(modules: tuple[Path, ...]) -> None:
    """Put the npm package together: `npm pack` makes an archive of it."""
    shutil.rmtree(PACKAGE, ignore_errors=True)
    shutil.copytree(ROOT / "web" / "package", PACKAGE)
    for module in modules:
        shutil.copyfile(module, PACKAGE / module.name)
    shutil.copyfile(ROOT / "LICENSE", PACKAGE / "LICENSE")
    compiler = (MODULES / ".bin" / "tsc", "-p", "web/package", "--outDir", PACKAGE)
    subprocess.run(compiler, cwd=ROOT, check=True)


def bundle_view(site: Path) -> None:
    """Make one file of the custom element and all that it needs, for the site and for the package."""
    script, module = site / "paint_worker.txt", site / "voxrt.wasm.zlib"
    bundle(site / "paint_worker.js", script, "--format=iife")
    module.write_bytes(zlib.compress(build_view().read_bytes(), 9))
    bundle(
        site / "voxrt_view.js", site / "voxrt-view.js", "--format=esm", "--loader:.txt=text", "--loader:.zlib=binary"
    )
    for path in (script, module, site / "voxrt_view.js"):
        path.unlink()
    shutil.copyfile(site / "voxrt-view.js", PACKAGE / "voxrt-view.js")


def bundle_offline(site: Path) -> None:
    """Make one script of the service worker and the list of the files that it keeps: all but what is loaded late."""
    late = {"boards", "voxrt-view.js", "voxrt_hardware.wasm", "offline.js", "package.json"}
    kept = [path for path in sorted(site.rglob("*")) if path.is_file() and late.isdisjoint(path.parts)]
    version = hashlib.sha256(b"".join(path.read_bytes() for path in kept)).hexdigest()[:16]
    files = json.dumps(["./", *(path.relative_to(site).as_posix() for path in kept)])
    known, script = site / "offline_files.js", site / "offline.js"
    known.write_text(f"export const version = {json.dumps(version)}, files = {files};\n", encoding="utf-8")
    bundle(script, script, "--format=iife", "--allow-overwrite")
    known.unlink()


def bundle(entry: Path, made: Path, *options: str) -> None:
    """Make one script of a module and of what it imports."""
    esbuild = (MODULES / ".bin" / "esbuild", "--bundle", "--minify", "--log-level=warning")
    subprocess.run((*esbuild, *options, entry, f"--outfile={made}"), check=True)


def add_examples(folder: Path) -> None:
    """Copy the example scenes; build the memory of the one that only voxrt reads."""
    folder.mkdir()
    for _, files in EXAMPLES.values():
        for name in files:
            if (ROOT / "examples" / name).exists():
                shutil.copyfile(ROOT / "examples" / name, folder / name)
    voxrt.build(ROOT / "examples" / "dog.usda", folder)


def add_three(folder: Path) -> None:
    """Copy the loaders and what they import. Workers have no import maps: names of packages become paths."""
    package = MODULES / "three"
    folder.mkdir()
    shutil.copyfile(package / "LICENSE", folder / "LICENSE")
    bundle(package / "build" / "three.core.js", folder / "three.core.js", "--format=esm")
    add_draco(package / "examples" / "jsm" / "libs" / "draco" / "gltf", folder / "draco")
    waiting = list(ADDONS)
    while waiting:
        name = waiting.pop()
        target = folder / "addons" / name
        if target.exists():
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        core = "../" * (name.count("/") + 1) + "three.core.js"
        text = (package / "examples" / "jsm" / name).read_text(encoding="utf-8")
        imported = [found[2] for found in IMPORT.findall(text)]
        waiting += [resolved(name, path) for path in imported if path.startswith(".")]
        text = IMPORT.sub(lambda m, core=core: f"{m[1]}'{core}'" if m[3] == "three" else m[0], text)
        target.write_text(without_manual(text), encoding="utf-8")


def add_draco(source: Path, folder: Path) -> None:
    """Copy the decoder of Draco; its script becomes a module that does not look for Node."""
    folder.mkdir()
    shutil.copyfile(source / "draco_decoder.wasm", folder / "draco_decoder.wasm")
    script = (source / "draco_wasm_wrapper.js").read_text(encoding="utf-8")
    head = "// Draco by Google, Apache License 2.0: https://github.com/google/draco\nconst process = undefined;\n"
    (folder / "draco_decoder.js").write_text(f"{head}{script}\nexport default DracoDecoderModule;\n", encoding="utf-8")


def without_manual(text: str) -> str:
    """Return a script without its comments of documentation, which are most of it; licences stay."""
    return MANUAL.sub(lambda m: m[0] if "@license" in m[0] else "", text)


def resolved(name: str, path: str) -> str:
    """Return the name of the addon that `name` imports as `path`."""
    parts = [*Path(name).parent.parts]
    for part in path.split("/"):
        if part == "..":
            parts.pop()
        elif part != ".":
            parts.append(part)
    return "/".join(parts)


if __name__ == "__main__":
    main()
