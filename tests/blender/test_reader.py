"""The reader of evaluated scenes, held against Blender's own glTF export, read by our loader."""

from __future__ import annotations

import numpy as np
import pytest
from msgspec.structs import replace

bpy = pytest.importorskip("bpy", reason="Blender's module bpy is not here: make blender-test")

import blender_scenes as scenes  # noqa: E402

import voxrt  # noqa: E402
from voxrt.voxelize.formats.blend.rendered import as_rendered  # noqa: E402
from voxrt.voxelize.formats.blend.scene import read_depsgraph  # noqa: E402

# What Blender's exporter leaves out by default: hair particles have no mesh there.
NOT_IN_GLTF = {"particles", "tufts"}
# What it writes with a transform of its own rounding: position, turn and scale, each as float32.
ROUNDED = {"waves"}


def read(name="scene", **options):
    return as_rendered(
        bpy.context.scene,
        bpy.context.view_layer,
        lambda depsgraph: read_depsgraph(depsgraph, bpy.data.materials, name, **options),
    )


def shown_colours(scene, bounds, depth=6):
    """The sRGB colour of each voxel, -1 for empty ones."""
    built = voxrt.build(scene, depth=depth, bounds=bounds)
    colours = [material.colour for material in built.rom.materials]
    table = np.array([-1, *(red << 16 | green << 8 | blue for red, green, blue in colours[1:])])
    return table[built.to_dense()]


def bounds_of(scene):
    points = np.concatenate(
        [
            one.mesh.positions[np.unique(one.mesh.triangles)] @ one.transform[:3, :3].T + one.transform[:3, 3]
            for one in scene.objects
        ]
    )
    # Off the corners of what is in it: a face on a grid plane would be decided by the last bit of a float32.
    low, high = points.min(axis=0) - 0.0123, points.max(axis=0) + 0.0171
    return (*low.tolist(), *high.tolist())


@pytest.mark.parametrize("name", [name for name in scenes.SCENES if name not in NOT_IN_GLTF])
def test_voxels_are_those_of_the_gltf_export(name, tmp_path):
    scenes.empty_file()
    scenes.SCENES[name]()
    ours = read()
    # The exporter evaluates as the viewport does.
    for one in bpy.data.objects:
        for modifier in one.modifiers:
            if modifier.type == "SUBSURF":
                modifier.levels = modifier.render_levels
    theirs = exported(tmp_path, export_apply=name != "shape_keys")  # which it drops where it applies modifiers
    bounds = bounds_of(ours)
    if name in ROUNDED:
        np.testing.assert_array_equal(shown_colours(ours, bounds) < 0, shown_colours(theirs, bounds) < 0)
        for one, same in zip(ours.objects, theirs.objects, strict=True):
            np.testing.assert_allclose(one.transform, same.transform, atol=1e-7)
        theirs = with_transforms_of(ours, theirs)
    np.testing.assert_array_equal(shown_colours(ours, bounds), shown_colours(theirs, bounds))


def exported(folder, **options):
    path = folder / "scene.glb"
    bpy.ops.export_scene.gltf(
        filepath=str(path), export_extras=True, export_gn_mesh=True, use_renderable=True, export_skins=False, **options
    )
    return voxrt.load(path)


def with_transforms_of(ours, theirs):
    objects = [replace(same, transform=one.transform) for one, same in zip(ours.objects, theirs.objects, strict=True)]
    return replace(theirs, objects=tuple(objects))


def test_particles_that_overlap_are_those_of_the_gltf_export_in_one_order(tmp_path):
    """The first of overlapping objects gives a voxel its material, and the exporter has another order."""
    scenes.empty_file()
    scenes.SCENES["tufts"]()
    ours = read()
    ball = bpy.data.objects["Sphere"]
    bpy.context.view_layer.objects.active = ball
    for one in bpy.data.objects:
        one.select_set(one == ball)
    bpy.ops.object.duplicates_make_real()
    ball.modifiers.clear()
    theirs = exported(tmp_path, export_apply=True)
    places = np.array([one.transform for one in theirs.objects])
    order = [np.abs(places - one.transform).max(axis=(1, 2)).argmin() for one in ours.objects]
    assert sorted(order) == list(range(len(theirs.objects)))
    theirs = with_transforms_of(ours, replace(theirs, objects=tuple(theirs.objects[number] for number in order)))
    bounds = bounds_of(ours)
    np.testing.assert_array_equal(shown_colours(ours, bounds), shown_colours(theirs, bounds))


def test_particles_are_instances():
    scenes.empty_file()
    scenes.SCENES["particles"]()
    scene = read()
    grains = [one for one in scene.objects if one.name.startswith("Plane/grain")]
    assert len(grains) == 20
    assert len({id(one.mesh) for one in grains}) == 1
    assert len({one.transform[:3, 3].tobytes() for one in grains}) == 20


def test_a_render_is_what_is_read():
    """Levels of subdivision and visibility are those of renders, and the scene's settings stay."""
    scenes.empty_file()
    shown = scenes.cube()
    subdivided = shown.modifiers.new("smooth", "SUBSURF")
    subdivided.levels, subdivided.render_levels = 0, 2
    scenes.cube((3, 0, 0)).hide_render = True
    scenes.cube((6, 0, 0)).hide_viewport = True
    render = bpy.context.scene.render
    before = render.engine, bpy.context.scene.camera, len(bpy.data.objects), render.use_compositing
    scene = read()
    assert [one.name for one in scene.objects] == ["cube", "cube.002"]
    assert len(scene.objects[0].mesh.triangles) == 6 * 4**2 * 2
    assert (render.engine, bpy.context.scene.camera, len(bpy.data.objects), render.use_compositing) == before


BODIES = {
    "BOX": ("BoxCollider", 8.0),
    "SPHERE": ("SphereCollider", 4 / 3 * np.pi),
    "CYLINDER": ("HullCollider", 2 * np.pi),
    "CONE": ("HullCollider", 2 * np.pi / 3),
    "CAPSULE": ("HullCollider", 4 / 3 * np.pi),
    "CONVEX_HULL": ("HullCollider", 8.0),
    "MESH": ("MeshCollider", 8.0),
}


@pytest.mark.parametrize("shape", BODIES)
def test_rigid_bodies_are_colliders(shape):
    """The volume of each shape is that which its formula gives for a cube of 2 m."""
    scenes.empty_file()
    one = scenes.cube()
    bpy.ops.rigidbody.object_add()
    one.rigid_body.collision_shape = shape
    scene = read()
    kind, volume = BODIES[shape]
    assert [type(one).__name__ for one in scene.objects[0].colliders] == [kind]
    bounds = (-1.61, -1.61, -1.61, 1.61, 1.61, 1.61)
    built = voxrt.build(scene, depth=7, bounds=bounds, rule="half", pow2="none")
    assert built.solid_voxels * built.rom.grid.voxel_size**3 == pytest.approx(volume, rel=0.03)


def test_rigid_bodies_that_are_not_shown_are_hidden_colliders():
    scenes.empty_file()
    scenes.monkey()
    proxy = scenes.cube((0, 0, 1), scenes.paint("red", (0.8, 0, 0)), name="proxy")
    bpy.ops.rigidbody.object_add()
    proxy.rigid_body.collision_shape = "BOX"
    proxy.hide_render = True
    scene = read()
    assert [(one.name, one.hidden, len(one.colliders)) for one in scene.objects] == [
        ("Suzanne", False, 0),
        ("proxy", True, 1),
    ]
    assert scene.materials[scene.objects[1].collider_material].name == "red"
    assert [one.name for one in voxrt.build(scene, depth=5).objects if one.voxels] == ["Suzanne"]
    built = voxrt.build(scene, depth=5, geometry="collider")
    assert {one.name: one.source for one in built.objects}["proxy"] == "box"


def test_box_colliders_are_rounded_to_powers_of_two():
    scenes.empty_file()
    one = scenes.cube(scale=(1.75, 0.9, 1.0))
    bpy.ops.rigidbody.object_add()
    one.rigid_body.collision_shape = "BOX"
    scenes.cube((8, 8, 8))
    built = voxrt.build(read(), voxel_size=1.0)
    report = built.objects[0]
    assert report.source == "box"
    assert report.voxels == 4 * 2 * 2  # 3.5 x 2 x 1.8 metres


@pytest.mark.parametrize(
    ("key", "value", "problem"),
    [
        (
            "voxrt_colider",
            "box",
            "object 'cube'.voxrt_colider: unknown property for voxrt; did you mean voxrt_collider?",
        ),
        ("voxrt_rule", "all", "object 'cube'.voxrt_rule: invalid enum value 'all'; use touch, centre, half"),
        ("voxrt_fill", "together", "object 'cube'.voxrt_fill: invalid enum value 'together'; use solid, surface, auto"),
        ("voxrt_material", "gold", "object 'cube'.voxrt_material: no material 'gold' in the file; it has no materials"),
    ],
)
def test_wrong_properties_are_refused(key, value, problem):
    scenes.empty_file()
    scenes.cube()[key] = value
    with pytest.raises(voxrt.AssetError, match="scene: ") as refused:
        read()
    assert str(refused.value) == f"scene: {problem}"


def test_vertices_that_are_nowhere_are_refused():
    scenes.empty_file()
    scenes.cube().data.vertices[5].co = (0, float("nan"), 0)
    with pytest.raises(voxrt.AssetError, match="scene: object 'cube', vertex 5: its coordinates are not finite; dele"):
        read()


def test_emission_is_as_bright_as_its_strength():
    """Linear 0.25 of it is 188 of 255 at twice the strength; what is brighter than white is clamped, and counted."""
    for strength, colour, clamped in ((2.0, (255, 188, 0), 0), (8.0, (255, 255, 0), 1)):
        scenes.empty_file()
        lamp = scenes.paint("lamp", (0, 0, 0))
        shader = lamp.node_tree.nodes["Principled BSDF"]
        shader.inputs["Emission Color"].default_value = (0.5, 0.25, 0, 1)
        shader.inputs["Emission Strength"].default_value = strength
        scenes.cube(material=lamp)
        scene = read()
        assert scene.materials[1].colour == colour
        assert [one.count for one in scene.warnings if one.kind == "colour-range"] == [1] * clamped


def test_a_scene_without_meshes_is_refused():
    """With what the scene has instead."""
    scenes.empty_file()
    with pytest.raises(voxrt.AssetError, match="to voxelize: the scene 'Scene' has no objects; check that renders"):
        read()
    scenes.cube().hide_render = True
    scenes.cube(name="ignored")["voxrt_ignore"] = True
    with pytest.raises(voxrt.AssetError, match="has 2 mesh; show a mesh in renders: hidden from them are 1"):
        read()


@pytest.mark.parametrize("size", [(640, 480), (300, 500)])
@pytest.mark.parametrize("fit", ["AUTO", "HORIZONTAL", "VERTICAL"])
def test_cameras_see_what_blender_projects(size, fit):
    """A point goes to the pixel to which Blender's own projection takes it, whatever the sensor and the shift."""
    from bpy_extras.object_utils import world_to_camera_view
    from mathutils import Vector

    from voxrt.views.viewpoint import authored_camera

    scenes.empty_file()
    scenes.cube()
    camera = scenes.link("camera", bpy.data.cameras.new("camera"))
    camera.location, camera.rotation_euler = (7, -6, 5), (1.1, 0.1, 0.8)
    camera.data.sensor_fit, camera.data.lens = fit, 40
    camera.data.shift_x, camera.data.shift_y = 0.15, -0.1
    scene = bpy.context.scene
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_y = size
    bpy.context.view_layer.update()
    found = read()
    grid = voxrt.fit_grid(found, depth=7)
    registers = authored_camera(found.viewpoint, grid, size)
    point = Vector((0.5, -0.4, 0.3))
    across, above, _ = world_to_camera_view(scene, camera, point)
    ray = (np.array((point.x, point.z, -point.y)) - grid.origin) / grid.voxel_size - np.array(registers.position) / 16
    look, right, up = np.linalg.solve(np.array((registers.look, registers.right, registers.up), float).T, ray)
    shown = right / look + size[0] / 2, size[1] / 2 - up / look
    # The registers hold right and up to one part in a hundred.
    assert shown == pytest.approx((across * size[0], (1 - above) * size[1]), abs=1.5)


def test_cameras_without_perspective_are_counted():
    scenes.empty_file()
    scenes.cube()
    camera = scenes.link("camera", bpy.data.cameras.new("camera"))
    camera.data.type = "ORTHO"
    bpy.context.scene.camera = camera
    scene = read()
    assert scene.cameras == ()
    assert [one.message for one in scene.warnings if one.kind == "camera"] == [
        "cameras without perspective were left out"
    ]


def test_sun_and_sky():
    scenes.empty_file()
    scenes.cube()
    sun = scenes.link("sun", bpy.data.lights.new("sun", "SUN"))
    sun.rotation_euler = (np.pi / 2, 0, 0)  # it stands in the direction -y of Blender, and shines along y
    world = scenes.with_nodes(bpy.data.worlds.new("world"))
    bpy.context.scene.world = world
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.25, 0.5, 1.0, 1)
    background.inputs["Strength"].default_value = 0.5
    from voxrt.voxelize.formats.blend.views import read_daylight

    light = as_rendered(bpy.context.scene, bpy.context.view_layer, read_daylight)
    assert light.sun == pytest.approx((0, 0, 1), abs=1e-6)
    assert light.sky == (99, 137, 188)  # of linear 0.125, 0.25 and 0.5
    assert light.sky_text == "#6389bc"
    assert read().materials[0].colour == light.sky


def test_what_nodes_compute_is_replaced_and_counted():
    scenes.empty_file()
    material = scenes.paint("noise", (1, 1, 1))
    tree = material.node_tree
    noise = tree.nodes.new("ShaderNodeTexNoise")
    tree.links.new(noise.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    material.diffuse_color = (0, 1, 0, 1)
    scenes.cube(material=material)
    scene = read()
    assert scene.materials[1].colour == (0, 255, 0)
    assert [one.message for one in scene.warnings] == [
        "materials whose colour is computed by nodes took their viewport colour"
    ]


def test_groups_and_reroutes_are_followed():
    scenes.empty_file()
    group = bpy.data.node_groups.new("paint", "ShaderNodeTree")
    group.interface.new_socket("Colour", in_out="INPUT", socket_type="NodeSocketColor")
    group.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    start, end = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    shader, reroute = group.nodes.new("ShaderNodeBsdfPrincipled"), group.nodes.new("NodeReroute")
    group.links.new(start.outputs[0], reroute.inputs[0])
    group.links.new(reroute.outputs[0], shader.inputs["Base Color"])
    group.links.new(shader.outputs[0], end.inputs[0])
    material = scenes.paint("grouped", (1, 1, 1))
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = group
    node.inputs[0].default_value = (1, 0, 0, 1)
    tree.links.new(node.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    scenes.cube(material=material)
    scene = read()
    assert scene.materials[1].colour == (255, 0, 0)
    assert scene.warnings == ()


def test_instances_share_one_mesh():
    scenes.empty_file()
    scenes.SCENES["collections"]()
    scene = read()
    assert len(scene.objects) == 6
    assert len({id(one.mesh) for one in scene.objects}) == 2
    assert scene.objects[0].name == "copy 0/cube"
