"""What commands import before they work."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from voxrt import cli

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"

LIBRARIES = {"numpy", "msgspec", "PIL", "trimesh", "pxr", "pyvista", "websockets", "asyncio", "concurrent", "http"}
RICH = {"rich", "markdown_it", "pygments"}
OTHER_WORK = {
    "numpy.ma",
    "voxrt.building.baking",
    "voxrt.board",
    "voxrt.building.fitting",
    "voxrt.voxelize.from_arrays",
    "voxrt.octree.budget",
    "voxrt.views.pictures",
    "voxrt.serve",
    "voxrt.sim._model",
    "voxrt.sim._rtl",
    "voxrt.view",
    "voxrt.voxelize.formats.usd",
}


def test_a_package_of_another_project_is_told(tmp_path):
    other = tmp_path / "voxrt"
    other.mkdir()
    (other / "__init__.py").write_text('__version__ = "9.9"\n')
    (other / "cli").symlink_to(Path(cli.__file__).parent)
    code = "import sys; from voxrt.cli import main; sys.argv = ['voxrt', '--version']; main()"
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, check=False, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith(f"voxrt: error: the package voxrt in {other} is that of another project")
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "unwanted"),
    [
        (["--version"], {*LIBRARIES, *RICH, *OTHER_WORK}),
        (["build", "--version"], {*LIBRARIES, *RICH, *OTHER_WORK}),
        (["--help"], {*LIBRARIES - {"msgspec"}, *RICH, *OTHER_WORK}),
        (["completion", "bash"], {*LIBRARIES - {"msgspec"}, *RICH, *OTHER_WORK}),
        (["build", "--help"], {*LIBRARIES - {"msgspec"}, *RICH, *OTHER_WORK}),
        (["build", "house.obj", "-o", "out", "--depth", "4"], {*LIBRARIES - {"numpy", "msgspec"}, *RICH, *OTHER_WORK}),
        (["build", "planet.glb", "--json", "-q"], {*LIBRARIES - {"numpy", "msgspec"}, *RICH, *OTHER_WORK}),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_a_command_imports_what_it_uses(tmp_path, arguments, unwanted):
    for name in ("house.obj", "house.mtl", "planet.glb"):
        shutil.copy(EXAMPLES / name, tmp_path)
    code = (
        "import sys\n"
        "before = set(sys.modules)\n"
        "from voxrt.cli import main\n"
        f"sys.argv = {['voxrt', *arguments]!r}\n"
        "try:\n    main()\n"
        f"finally:\n    print(*({unwanted!r} & set(sys.modules)) - before, file=sys.stderr)"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, check=True, capture_output=True, text=True)
    assert [line for line in done.stderr.splitlines() if "warning" not in line][-1] == ""


@pytest.mark.parametrize(("chosen", "used"), [(None, "1"), ("3", "3")])
def test_blas_has_one_thread_unless_the_caller_chose(tmp_path, chosen, used):
    environment = {name: value for name, value in os.environ.items() if name != "OPENBLAS_NUM_THREADS"}
    environment |= {"OPENBLAS_NUM_THREADS": chosen} if chosen else {}
    code = (
        "import os, sys\n"
        "from voxrt.cli import main\n"
        f"sys.argv = ['voxrt', 'build', {str(EXAMPLES / 'house.obj')!r}, '--depth', '4', '-q']\n"
        "try:\n    main()\n"
        "finally:\n    print(os.environ['OPENBLAS_NUM_THREADS'])"
    )
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True, env=environment)
    assert done.stdout.splitlines()[-1] == used


@pytest.mark.parametrize(("arguments", "code"), [(["--version"], 0), (["info", "nothing.mem"], 3), (["infos"], 2)])
def test_an_installed_command_ends_as_the_module_does(tmp_path, arguments, code):
    """It leaves its memory to the system, but runs exit handlers first, and says and returns the same."""
    script = "import atexit, sys; from voxrt.cli import script; atexit.register(print, 'handler')\n"
    script += f"sys.argv = {['voxrt', *arguments]!r}\ntry:\n    script()\nfinally:\n    print('unwound')"
    ended = subprocess.run([sys.executable, "-c", script], cwd=tmp_path, check=False, capture_output=True, text=True)
    command = [sys.executable, "-m", "voxrt", *arguments]
    module = subprocess.run(command, cwd=tmp_path, check=False, capture_output=True, text=True)
    assert (ended.returncode, ended.stderr) == (module.returncode, module.stderr)
    assert ended.returncode == code
    assert ended.stdout == f"{module.stdout}handler\n"


@pytest.mark.parametrize(
    ("preparation", "lines"),
    [
        ("threading.Thread(target=lambda: (threading.main_thread().join(), print('joined'))).start()", ["joined"]),
        ("sys.setprofile(lambda *_: None)", []),
        ("sys.settrace(lambda *_: None)", []),
    ],
)
def test_an_installed_command_ends_as_python_does_for_threads_and_profilers(tmp_path, preparation, lines):
    script = f"import sys, threading; from voxrt.cli import script; {preparation}; sys.argv = ['voxrt', '--version']\n"
    script += "try:\n    script()\nfinally:\n    print('unwound')"
    command = [sys.executable, "-c", script]
    done = subprocess.run(command, cwd=tmp_path, check=True, capture_output=True, text=True)
    assert done.stdout.splitlines()[1:] == ["unwound", *lines]
