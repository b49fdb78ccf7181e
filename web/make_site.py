"""Put the static page together: build/site, which any web server can serve, from any path.

It holds the page (web/page), what it shares with the page of the server (serve/page), the npm package (web/package)
with the modules of web/build_voxrt.py and web/build_hardware.py, the loaders of three.js from npm without their
manuals, and example scenes. Nothing is bundled.

    python web/make_site.py            # needs the package voxrt, npm, and the group `web` of pyproject.toml
    python -m http.server -d build/site
"""

from __future__ import annotations

import base64
import hashlib
import json
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

from board_files import add_boards
from build_hardware import build_hardware
from build_voxrt import build
from compiler import BUILD, ROOT

import voxrt
from voxrt.octree import BOARDS

SITE = ROOT / "build" / "site"
PACKAGE = BUILD / "package"

THREE = ("three@0.187.0", "Qiu7R+Cmh8CstZsY1uJOSWnVlfo7ZtNLV7mF8Jltk3LB3AtDu9cRZlcnRKkAk8Y4z6KKw35z7Y7Urd7jWY8etA==")
AXE = ("axe-core@4.14.1", "FHfa+lmNjQZfJz1q8wKqIDwC6DExcHt/pkjNQb09a3NPjCKg2rhu5qb2S4r76ASyFNNtuFooJpZe37OgudVGtQ==")
"""Packages of npm and their hashes. axe-core, which checks pages for accessibility, is for tests alone."""
LOADERS = ("GLTFLoader", "OBJLoader", "MTLLoader", "STLLoader", "PLYLoader", "USDLoader")
ADDONS = (*(f"loaders/{name}.js" for name in LOADERS), "libs/meshopt_decoder.module.js")
MANUAL = re.compile(r"^[ \t]*/\*\*\n(?:[ \t]*\*(?!/).*\n)*[ \t]*\*/\n", re.MULTILINE)
IMPORT = re.compile(r"""(from\s+)(['"])([^'"]+)\2""")

SHARED = (
    "camera.js", "controls.css", "elements.js", "figures.js", "flight.js", "frame_requests.js", "gestures.js",
    "glide.js", "icon.svg", "light.js", "navigation.js", "notices.js", "picture.js", "pilot.js", "resolution.js",
    "style.css", "vectors.js", "views.js",
)  # fmt: skip
"""Files of the server's page."""

SCRIPTS = ("voxrt.js", "instance.js", "scene.js", "hardware.js")
"""Files of the package."""

EXAMPLES = {
    "courtyard": ("Courtyard", ("courtyard.glb",)),
    "planet": ("Planet", ("planet.glb",)),
    "house": ("House", ("house.obj", "house.mtl")),
    "dog": ("Dog", ("dog.mem", "dog.json")),
}
"""Name: title and files. The dog's boxes are physics colliders, which only voxrt reads: its memory is built here."""


def main() -> None:
    """Build the modules, and put the site together anew."""
    make_site(build(), build_hardware("tiny"))
    npm_package(*AXE)
    files = [path for path in SITE.rglob("*") if path.is_file()]
    print(f"{SITE.relative_to(ROOT)}: {len(files)} files, {sum(path.stat().st_size for path in files):,} bytes")


def make_site(*modules: Path) -> None:
    """Put the site together in a folder of its own, then in place of the old one."""
    made = BUILD / "site"
    shutil.rmtree(made, ignore_errors=True)
    shutil.copytree(ROOT / "web" / "page", made)
    for name in SHARED:
        shutil.copyfile(ROOT / "serve" / "page" / name, made / name)
    make_package(modules)
    (made / "voxrt").mkdir()
    for name in (*SCRIPTS, *(module.name for module in modules)):
        shutil.copyfile(PACKAGE / name, made / "voxrt" / name)
    shutil.copyfile(ROOT / "LICENSE", made / "LICENSE")
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
    shutil.rmtree(SITE, ignore_errors=True)
    made.rename(SITE)


def make_package(modules: tuple[Path, ...]) -> None:
    """Put the npm package together: `npm pack` makes an archive of it."""
    shutil.rmtree(PACKAGE, ignore_errors=True)
    shutil.copytree(ROOT / "web" / "package", PACKAGE)
    for module in modules:
        shutil.copyfile(module, PACKAGE / module.name)
    shutil.copyfile(ROOT / "LICENSE", PACKAGE / "LICENSE")


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
    package = npm_package(*THREE)
    folder.mkdir()
    shutil.copyfile(package / "LICENSE", folder / "LICENSE")
    core = (package / "build" / "three.core.js").read_text(encoding="utf-8")
    (folder / "three.core.js").write_text(without_manual(core), encoding="utf-8")
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


def npm_package(name: str, integrity: str) -> Path:
    """Return the folder of a package; npm fetches it once. `integrity`: SHA-512, as npm's registry gives it."""
    folder = BUILD / "npm" / name.replace("@", "-")
    if not folder.exists():
        if shutil.which("npm") is None:
            sys.exit(f"web/make_site.py fetches {name} by npm, which is not here: apt install npm")
        with tempfile.TemporaryDirectory(dir=BUILD) as scratch:
            subprocess.run(["npm", "pack", "--silent", name], cwd=scratch, check=True, stdout=subprocess.DEVNULL)
            archive = Path(scratch) / f"{name.replace('@', '-')}.tgz"
            if base64.b64encode(hashlib.sha512(archive.read_bytes()).digest()).decode() != integrity:
                sys.exit(f"{name}: the registry has another package than the one that was pinned in web/make_site.py")
            with tarfile.open(archive) as packed:
                packed.extractall(scratch, filter="data")
            folder.parent.mkdir(exist_ok=True)
            (Path(scratch) / "package").rename(folder)
    return folder


if __name__ == "__main__":
    main()
