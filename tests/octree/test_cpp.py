"""The C++ libraries as others build them; `make sanitize` builds the examples too, without CMake."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest

import voxrt

ROOT = Path(__file__).resolve().parents[2]
LIBRARIES = ("libvoxrt_voxelize.a", "libvoxrt_octree.a")
CONSUMER = """
cmake_minimum_required(VERSION 3.25)
project(consumer LANGUAGES CXX)
find_package(voxrt {version} REQUIRED)
add_executable(consumer {program})
target_link_libraries(consumer PRIVATE voxrt::ray voxrt::octree voxrt::voxelize)
"""

pytestmark = [
    pytest.mark.xdist_group("cpp"),
    pytest.mark.skipif(not (shutil.which("cmake") and shutil.which("c++")), reason="no CMake or no C++ compiler"),
]


def cmake(*arguments):
    return subprocess.run(["cmake", *map(str, arguments)], check=False, capture_output=True, text=True)


def configure(source, build, *options):
    configured = cmake("-S", source, "-B", build, *options)
    if "or higher is required" in configured.stderr:
        pytest.skip("an old CMake")
    return configured


def build(source, folder, *options):
    configured = configure(source, folder, *options)
    assert configured.returncode == 0, configured.stderr
    built = cmake("--build", folder, "--parallel", "2")
    assert built.returncode == 0, built.stdout + built.stderr


@pytest.fixture(scope="module")
def built(tmp_path_factory):
    """Where the examples are built from the sources, and the libraries with them."""
    folder = tmp_path_factory.mktemp("build")
    build(ROOT / "examples" / "cpp", folder, "-DCMAKE_DISABLE_FIND_PACKAGE_voxrt=ON")
    return folder


@pytest.fixture(scope="module")
def installed(built, tmp_path_factory):
    """Where the libraries are installed."""
    place = tmp_path_factory.mktemp("installed")
    finished = cmake("--install", built, "--prefix", place)
    assert finished.returncode == 0, finished.stderr
    return place


def consume(installed, folder, program, version):
    folder.mkdir()
    (folder / "CMakeLists.txt").write_text(CONSUMER.format(program=program.as_posix(), version=version))
    return folder, folder / "build", f"-DCMAKE_PREFIX_PATH={installed}"


@pytest.mark.parametrize(("program", "says"), [("mesh_to_ray", "hits material 2"), ("query_octree", "hits material")])
def test_a_program_finds_the_installed_package(installed, tmp_path, program, says):
    example = ROOT / "examples" / "cpp" / f"{program}.cpp"
    source, folder, prefix = consume(
        installed, tmp_path / "consumer", example, ".".join(voxrt.__version__.split(".")[:2])
    )
    build(source, folder, prefix)
    assert says in subprocess.run([folder / "consumer"], check=True, capture_output=True, text=True).stdout


def test_another_version_is_not_found(installed, tmp_path):
    major, minor = map(int, voxrt.__version__.split(".")[:2])
    example = ROOT / "examples" / "cpp" / "query_octree.cpp"
    refused = configure(*consume(installed, tmp_path / "consumer", example, f"{major}.{minor + 1}"))
    assert refused.returncode != 0
    assert f"version: {voxrt.__version__}" in refused.stderr


def test_the_package_has_the_version_of_voxrt(installed):
    text = (installed / "lib" / "cmake" / "voxrt" / "voxrtConfigVersion.cmake").read_text()
    assert re.search(r'set\(PACKAGE_VERSION "(.*)"\)', text)[1] == voxrt.__version__


def test_every_installed_header_compiles_alone(installed, tmp_path):
    headers = sorted((installed / "include").rglob("*.h"))
    rooms = {header.relative_to(installed / "include" / "voxrt").parts[0] for header in headers}
    assert rooms == {"voxelize", "octree", "sim"}
    lines = [f"#include <{header.relative_to(installed / 'include').as_posix()}>\n" for header in headers]
    for number, line in enumerate(lines):
        (tmp_path / f"{number}.cpp").write_text(line)
    sources = [tmp_path / f"{number}.cpp" for number in range(len(lines))]
    command = ["c++", "-std=c++20", "-fsyntax-only", "-I", installed / "include", *sources]
    compiled = subprocess.run(command, check=False, capture_output=True, text=True)
    assert compiled.returncode == 0, compiled.stderr


def test_no_message_of_the_libraries_names_python(installed):
    for library in LIBRARIES:
        texts = re.findall(rb"[ -~]{12,}", (installed / "lib" / library).read_bytes())
        messages = [text for text in texts if b" " in text]
        assert messages
        assert not [text for text in messages if re.search(rb"[Pp]ython|numpy|decode|voxrt\.", text)]


@pytest.mark.parametrize("program", ["mesh_to_ray", "query_octree"])
def test_the_examples_build_from_the_sources(built, program):
    subprocess.run([built / program], check=True, capture_output=True)
