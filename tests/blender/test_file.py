"""Blender files: read in a process of their own, or refused in one line."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

bpy = pytest.importorskip("bpy", reason="Blender's module bpy is not here: make blender-test")

import blender_scenes as scenes  # noqa: E402

import voxrt  # noqa: E402
from voxrt.voxelize.formats.blend import isolated  # noqa: E402
from voxrt.voxelize.formats.reader_process.limits import Limits  # noqa: E402


def saved(path):
    bpy.ops.wm.save_as_mainfile(filepath=str(path), check_existing=False)
    return path


@pytest.fixture
def cube_file(tmp_path):
    scenes.empty_file()
    scenes.cube(material=scenes.paint("red", (0.8, 0, 0)))
    return saved(tmp_path / "cube.blend")


def refusal(path, **options):
    with pytest.raises(voxrt.AssetError) as caught:
        voxrt.load(path, **options)
    message = str(caught.value)
    assert "\n" not in message
    assert message.startswith(f"{path}: ")
    return message.removeprefix(f"{path}: ")


def test_a_file_is_what_its_scene_is(cube_file):
    scene = voxrt.load(cube_file)
    assert scene.name == "cube"
    assert [one.name for one in scene.objects] == ["cube"]
    assert scene.materials[1].name == "red"
    assert scene.warnings == ()


def test_a_camera_and_a_sky_come_through(tmp_path):
    scenes.empty_file()
    scenes.cube()
    camera = scenes.link("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.data.shift_x = (0, -9, 0), 0.25
    scene = bpy.context.scene
    scene.camera, scene.world = camera, scenes.with_nodes(bpy.data.worlds.new("world"))
    scene.render.resolution_x, scene.render.resolution_y = 640, 320
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (1, 0, 0, 1)
    found = voxrt.load(saved(tmp_path / "view.blend"))
    assert found.viewpoint.name == "camera"
    assert found.viewpoint.eye == pytest.approx((0, 0, 9))
    assert found.viewpoint.shift == pytest.approx((0.5, 0))  # a quarter of the width
    assert found.materials[0].colour == (255, 0, 0)


def test_the_parent_never_imports_blender(cube_file):
    code = f"import sys, voxrt; print(voxrt.load({str(cube_file)!r})); assert 'bpy' not in sys.modules"
    printed = subprocess.run([sys.executable, "-P", "-c", code], capture_output=True, text=True, check=True)
    assert "objects=1" in printed.stdout


def test_a_second_of_the_animation(tmp_path):
    scenes.empty_file()
    one = scenes.cube()
    for frame, place in ((1, 0.0), (49, 8.0)):
        one.location.x = place
        one.keyframe_insert("location", frame=frame)
    for curve in one.animation_data.action.layers[0].strips[0].channelbag(one.animation_data.action_slot).fcurves:
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"
    path = saved(tmp_path / "moving.blend")
    assert voxrt.load(path, time=1.0).objects[0].transform[0, 3] == pytest.approx(4.0)
    built = voxrt.build_animation(path, times=(0, 1), depth=4)
    assert len(set(built.animation.roots)) == 2


def test_scripts_are_not_run(tmp_path):
    scenes.empty_file()
    one = scenes.cube()
    mark = tmp_path / "mark"
    text = bpy.data.texts.new("register.py")
    text.write(f"open({str(mark)!r}, 'w')")
    text.use_module = True
    driver = one.driver_add("location", 0).driver
    driver.expression = f"len(open({str(mark)!r}, 'w').name)"
    path = saved(tmp_path / "script.blend")
    mark.unlink(missing_ok=True)  # the driver ran here when it was made
    scene = voxrt.load(path)
    assert not mark.exists()
    assert [one.message for one in scene.warnings if one.kind == "script"] == [
        "scripts in the file, and drivers that are scripts, were not run"
    ]


def linked(folder, library):
    """A file in `folder` that links the cube of a file elsewhere."""
    scenes.empty_file()
    with bpy.data.libraries.load(str(library), link=True) as (_, wanted):
        wanted.objects = ["cube"]
    bpy.context.scene.collection.objects.link(bpy.data.objects["cube"])
    folder.mkdir(exist_ok=True)
    return saved(folder / "linked.blend")


def test_libraries_are_read(cube_file):
    path = linked(cube_file.parent, cube_file)
    assert [one.name for one in voxrt.load(path).objects] == ["cube"]


def test_libraries_outside_are_refused(cube_file, tmp_path):
    path = linked(tmp_path / "inner", cube_file)
    assert "is outside the file's folder; put it into the asset's folder, or allow it" in refusal(path)
    assert len(voxrt.load(path, allow_outside=True).objects) == 1


def test_the_brushes_of_blender_are_no_library_outside():
    """Files in which somebody has painted link them; this one comes with Blender."""
    folder = Path(bpy.utils.system_resource("SCRIPTS")) / "startup/bl_app_templates_system/2D_Animation"
    path = folder / "startup.blend"
    assert refusal(path) == (
        "has no triangles to voxelize: the scene 'Scene' has 1 camera, 1 grease pencil; "
        "check that renders of that scene show a mesh"
    )


def test_missing_libraries_are_refused(cube_file):
    path = linked(cube_file.parent, cube_file)
    cube_file.unlink()
    message = refusal(path)
    assert message.endswith("was not found or cannot be read; put it there, or make its data local in Blender")


def test_images_outside_are_not_opened(tmp_path):
    scenes.empty_file()
    material, node = scenes.textured()
    image = node.image
    image.filepath_raw, image.file_format = str(tmp_path / "checks.png"), "PNG"
    image.save()
    image.unpack(method="REMOVE")
    image.source = "FILE"
    scenes.cube(material=material)
    inner = tmp_path / "inner"
    inner.mkdir()
    path = saved(inner / "outside.blend")
    scene = voxrt.load(path)
    assert any("is outside the file's folder and was not opened" in one.message for one in scene.warnings)
    assert all(one.mesh.appearance is None for one in scene.objects)
    assert voxrt.load(path, allow_outside=True).objects[0].mesh.appearance is not None


def test_files_outside_cannot_be_opened_by_any_way(cube_file, tmp_path):
    """The kernel refuses what the reader does not look at: a volume, a sound, a cache."""
    from voxrt.voxelize.file_sandbox import confine

    code = (
        "from pathlib import Path; from voxrt.voxelize.file_sandbox import confine\n"
        f"print(confine((Path({str(tmp_path / 'inner')!r}),)))\n"
        "import bpy\n"
        f"try: bpy.ops.wm.open_mainfile(filepath={str(cube_file)!r})\n"
        "except RuntimeError: print('refused')"
    )
    assert callable(confine)
    (tmp_path / "inner").mkdir()
    printed = subprocess.run([sys.executable, "-P", "-c", code], capture_output=True, text=True, check=True)
    if "True" not in printed.stdout:
        pytest.skip("this kernel has no Landlock")
    assert "refused" in printed.stdout


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        (b"", "is not a Blender file; check the file"),
        (b"solid nothing", "is not a Blender file; check the file"),
        (b"BLENDER", "Blender cannot open it"),
        (b"BLENDER-v250" + bytes(200), "Blender cannot open it"),
        (b"\x28\xb5\x2f\xfd" + bytes(50), "Blender cannot open it"),
    ],
)
def test_what_is_no_file_of_blender_is_one_line(tmp_path, content, problem):
    path = tmp_path / "wrong.blend"
    path.write_bytes(content)
    assert refusal(path).startswith(problem)


def test_damaged_files_are_one_line(cube_file):
    """Files that are cut, and files with wrong bytes: a scene or one line."""
    whole = cube_file.read_bytes()
    path = cube_file.with_name("damaged.blend")
    damaged = [whole[: len(whole) // 2], whole[:40] + b"\xff" * 400 + whole[440:]]
    for content in damaged:
        path.write_bytes(content)
        message = outcome(path)
        assert "\n" not in message
        assert not message or message.startswith(f"{path}: ")


def outcome(path):
    """The error of a file, empty for none."""
    try:
        voxrt.load(path)
    except voxrt.AssetError as error:
        return str(error)
    return ""


def test_old_files_of_another_byte_order_are_refused(tmp_path):
    path = tmp_path / "old.blend"
    path.write_bytes(b"BLENDER_V249" + bytes(400))
    assert refusal(path) == (
        "was saved by Blender 2.49 on a processor of another byte order; open it in Blender 4 and save it again"
    )


def test_time_is_limited(tmp_path):
    scenes.empty_file()
    one = scenes.monkey()
    for _ in range(3):
        one.modifiers.new("smooth", "SUBSURF").render_levels = 4
    path = saved(tmp_path / "heavy.blend")
    least = Limits(memory=3 << 30, most_memory=3 << 30, seconds=1)
    with pytest.raises(
        voxrt.AssetError, match=r"heavy\.blend: (takes more than 1 seconds|needs more memory|Blender cr)"
    ):
        isolated.read_isolated(path, limits=least)


def test_memory_is_limited(tmp_path):
    """Blender crashes where it gets no memory; the line says what it has printed before."""
    scenes.empty_file()
    scenes.cube().modifiers.new("many", "ARRAY").count = 3_000_000
    path = saved(tmp_path / "many.blend")
    least = Limits(memory=2 << 30, most_memory=2 << 30, seconds=60)
    with pytest.raises(voxrt.AssetError, match=r"many\.blend: needs more memory than a file of its size may take"):
        isolated.read_isolated(path, limits=least)


LAUNCHER = """#!{python} -P
# The module bpy with the few options of the program that voxrt gives it.
import sys
print("Blender 5.3.0")  # as the program does while it starts
import bpy
options = sys.argv[1:]
assert options[:5] == ["--background", "--factory-startup", "--disable-autoexec", "--python-exit-code", "1"]
assert options[5] == "--python-expr"
exec(options[6])
"""


@pytest.fixture
def program(tmp_path, monkeypatch):
    """A program `blender` on the path, which is the module bpy; voxrt itself has no such module."""
    file = tmp_path / "bin" / "blender"
    file.parent.mkdir()
    file.write_text(LAUNCHER.format(python=sys.executable))
    file.chmod(0o755)
    monkeypatch.setenv("PATH", str(file.parent))
    monkeypatch.setattr(isolated, "find_spec", lambda _: None)
    return file


@pytest.mark.usefixtures("program")
def test_the_program_reads_a_file_too(cube_file):
    assert [one.name for one in voxrt.load(cube_file).objects] == ["cube"]


def test_a_program_of_another_python_is_one_line(cube_file, program, monkeypatch):
    monkeypatch.setattr(isolated, "_PYTHON", "3.99")
    shown = f"{sys.version_info[0]}.{sys.version_info[1]}"
    assert refusal(cube_file).startswith(f"{program} has Python {shown}, and this voxrt is for 3.99; pip install bpy")


def test_without_blender_one_line_says_how_to_get_it(cube_file, monkeypatch):
    monkeypatch.setattr(isolated, "find_spec", lambda _: None)
    monkeypatch.setenv("PATH", "")
    assert refusal(cube_file) == (
        "Blender, which reads it, is not here; "
        "pip install bpy, install Blender, or export the scene as glTF from Blender"
    )


def test_options_of_other_formats_are_ignored_with_a_warning(cube_file):
    scene = voxrt.load(cube_file, up="z")
    assert [one.message for one in scene.warnings] == ["the up axis was ignored: blend files define it"]


def test_the_command_builds_it(cube_file):
    command = [sys.executable, "-P", "-m", "voxrt", "build", cube_file, "-o", cube_file.parent, "--depth", "4"]
    printed = subprocess.run(command, capture_output=True, text=True, check=False, cwd=cube_file.parent)
    assert printed.returncode == 0, printed.stderr
    assert Path(cube_file.parent, "cube.mem").exists()
