"""Scenes that Blender makes: what each function's name says, in an empty file."""

from __future__ import annotations

import math

import bpy

SCENES = {}


def scene(function):
    SCENES[function.__name__] = function
    return function


def empty_file():
    bpy.ops.wm.read_factory_settings(use_empty=True)


def link(name, data=None):
    made = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(made)
    return made


def cube(location=(0.0, 0.0, 0.0), material=None, scale=(1.0, 1.0, 1.0), name="cube"):
    bpy.ops.mesh.primitive_cube_add(location=location)
    made = bpy.context.object
    made.scale = scale
    made.name = name
    if material is not None:
        made.data.materials.append(material)
    return made


def monkey(location=(0.0, 0.0, 0.0), material=None):
    bpy.ops.mesh.primitive_monkey_add(location=location, rotation=(0.1, 0.2, 0.3))
    if material is not None:
        bpy.context.object.data.materials.append(material)
    return bpy.context.object


def with_nodes(owner):
    """A material or a world that has nodes, as all have since Blender 5."""
    if bpy.app.version < (5, 0, 0):
        owner.use_nodes = True
    return owner


def paint(name, colour, **inputs):
    """A material of one colour, linear red, green, blue."""
    material = with_nodes(bpy.data.materials.new(name))
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1.0)
    for key, value in inputs.items():
        shader.inputs[key.replace("_", " ").title()].default_value = value
    return material


def paint_by(attribute, name, data):
    """Give a mesh a material whose colour is that of an attribute."""
    material = paint(name, (1, 1, 1))
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeVertexColor")
    node.layer_name = attribute
    tree.links.new(node.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    data.materials.append(material)


def image(name="checks", size=8, alpha=False):
    made = bpy.data.images.new(name, size, size, alpha=True)
    pixels = []
    for row in range(size):
        for column in range(size):
            on = (row // 2 + column // 2) % 2
            red = 0.9 if on else 0.1
            pixels += [red, row / size, column / size, float(on) if alpha else 1.0]
    made.pixels.foreach_set(pixels)
    made.update()
    made.pack()
    return made


def textured(name="checks", alpha=False, **settings):
    """A material with an image texture; return it and the texture's node."""
    material = paint(name, (1, 1, 1))
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeTexImage")
    node.image = image(name, alpha=alpha)
    for key, value in settings.items():
        setattr(node, key, value)
    shader = tree.nodes["Principled BSDF"]
    tree.links.new(node.outputs["Color"], shader.inputs["Base Color"])
    if alpha:
        tree.links.new(node.outputs["Alpha"], shader.inputs["Alpha"])
    return material, node


def geometry_nodes(owner, *, realize):
    """Give an object a node group that puts small cubes of its own material on its corners."""
    group = bpy.data.node_groups.new("corners", "GeometryNodeTree")
    group.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    group.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    nodes, links = group.nodes, group.links
    start, end = nodes.new("NodeGroupInput"), nodes.new("NodeGroupOutput")
    box, place, join = (
        nodes.new(kind) for kind in ("GeometryNodeMeshCube", "GeometryNodeInstanceOnPoints", "GeometryNodeJoinGeometry")
    )
    box.inputs["Size"].default_value = (0.5, 0.4, 0.3)
    links.new(start.outputs[0], place.inputs["Points"])
    coat = nodes.new("GeometryNodeSetMaterial")
    coat.inputs["Material"].default_value = owner.data.materials[0]
    links.new(box.outputs["Mesh"], coat.inputs["Geometry"])
    links.new(coat.outputs[0], place.inputs["Instance"])
    last = place.outputs["Instances"]
    if realize:
        real = nodes.new("GeometryNodeRealizeInstances")
        links.new(last, real.inputs[0])
        last = real.outputs[0]
    links.new(last, join.inputs[0])
    links.new(start.outputs[0], join.inputs[0])
    links.new(join.outputs[0], end.inputs[0])
    owner.modifiers.new("corners", "NODES").node_group = group


@scene
def modifiers():
    one = monkey(material=paint("skin", (0.6, 0.3, 0.1)))
    one.modifiers.new("smooth", "SUBSURF").render_levels = 1
    array = one.modifiers.new("row", "ARRAY")
    array.count = 2
    bevelled = cube((0, 4, 0), paint("red", (0.8, 0, 0)))
    bevelled.modifiers.new("edge", "BEVEL").width = 0.3


@scene
def boolean():
    one, other = cube(material=paint("grey", (0.5, 0.5, 0.5))), monkey((0.7, 0.7, 0.7))
    cut = one.modifiers.new("cut", "BOOLEAN")
    cut.object = other
    cut.solver = "EXACT"
    other.hide_render = True
    other.hide_viewport = True


@scene
def geometry_nodes_realized():
    geometry_nodes(cube(material=paint("blue", (0, 0, 0.7))), realize=True)


@scene
def geometry_nodes_instances():
    geometry_nodes(cube(material=paint("blue", (0, 0, 0.7))), realize=False)


@scene
def collections():
    part = bpy.data.collections.new("part")
    for number in range(2):
        one = cube((number * 1.5, 0, 0), paint(f"paint {number}", (number * 0.5, 0.3, 0.2)), (0.5, 0.5, 0.5 + number))
        bpy.context.scene.collection.objects.unlink(one)
        part.objects.link(one)
    for number in range(3):
        copy = link(f"copy {number}")
        copy.instance_type, copy.instance_collection = "COLLECTION", part
        copy.location, copy.rotation_euler = (0, number * 3, number), (0, 0, 0.3 * number)


@scene
def curves():
    bpy.ops.curve.primitive_bezier_circle_add(radius=2)
    bpy.context.object.data.bevel_depth = 0.3
    bpy.context.object.data.materials.append(paint("wire", (0.7, 0.5, 0.1)))


@scene
def text():
    bpy.ops.object.text_add(rotation=(math.pi / 2, 0, 0))
    one = bpy.context.object
    one.data.body, one.data.extrude = "voxrt", 0.1
    one.data.materials.append(paint("ink", (0.02, 0.02, 0.1)))


@scene
def armature():
    one = cube(scale=(1, 1, 1), material=paint("arm", (0.8, 0.6, 0.5)))
    for vertex in one.data.vertices:
        vertex.co.z *= 3
    bpy.ops.object.armature_add(enter_editmode=False, location=(0, 0, -3))
    bones = bpy.context.object
    one.parent = bones
    one.matrix_parent_inverse = bones.matrix_world.inverted()
    group = one.vertex_groups.new(name="Bone")
    group.add([v.index for v in one.data.vertices if v.co.z > 0], 1.0, "REPLACE")
    one.modifiers.new("bones", "ARMATURE").object = bones
    pose = bones.pose.bones["Bone"]
    pose.rotation_mode = "XYZ"
    pose.rotation_euler = (0.2, 0.1, 0.4)


@scene
def shape_keys():
    one = cube(material=paint("clay", (0.5, 0.2, 0.1)))
    one.shape_key_add(name="Basis")
    key = one.shape_key_add(name="tall")
    for point in key.data:
        point.co.z *= 2 if point.co.z > 0 else 1
    key.value = 0.75


@scene
def negative_scales():
    one = monkey(material=paint("skin", (0.6, 0.3, 0.1)))
    one.scale = (-1, 1, 1)
    other = monkey((3, 0, 0))
    other.scale = (1, -1.5, -0.5)


@scene
def parents():
    top = link("top")
    top.rotation_euler, top.scale = (0.3, 0.2, 0.9), (1.5, 1.5, 1.5)
    one = cube((2, 0, 0), paint("red", (0.8, 0, 0)))
    one.parent = top
    other = cube((0, 2, 0.25), paint("green", (0, 0.8, 0)), (0.5, 0.5, 2))
    other.parent = one


@scene
def linked_meshes():
    one = monkey(material=paint("skin", (0.6, 0.3, 0.1)))
    for number in range(1, 4):
        copy = link(f"copy {number}", one.data)
        copy.location = (number * 2.5, 0, 0)
    copy.material_slots[0].link = "OBJECT"
    copy.material_slots[0].material = paint("jade", (0, 0.5, 0.2))


@scene
def several_materials():
    one = cube()
    for number in range(3):
        one.data.materials.append(paint(f"side {number}", (number / 3, 1 - number / 3, 0.2)))
    for face in one.data.polygons:
        face.material_index = face.index % 3


@scene
def image_texture():
    material, _ = textured(interpolation="Closest")
    cube(material=material)


@scene
def moved_texture():
    material, node = textured(interpolation="Closest", extension="EXTEND")
    tree = material.node_tree
    places, moved = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeMapping")
    tree.links.new(places.outputs["UV"], moved.inputs["Vector"])
    tree.links.new(moved.outputs["Vector"], node.inputs["Vector"])
    moved.inputs["Location"].default_value = (0.1, 0.2, 0)
    moved.inputs["Scale"].default_value = (2, 1.5, 1)
    cube(material=material)


@scene
def tinted_texture():
    material, node = textured(interpolation="Closest")
    tree = material.node_tree
    mix = tree.nodes.new("ShaderNodeMix")
    mix.data_type, mix.blend_type = "RGBA", "MULTIPLY"
    mix.inputs[0].default_value = 1.0
    tree.links.new(node.outputs["Color"], mix.inputs[6])
    mix.inputs[7].default_value = (1.0, 0.5, 0.25, 1.0)
    tree.links.new(mix.outputs[2], tree.nodes["Principled BSDF"].inputs["Base Color"])
    cube(material=material)


@scene
def clipped_texture():
    material, node = textured(alpha=True, interpolation="Closest")
    tree = material.node_tree
    cut = tree.nodes.new("ShaderNodeMath")
    cut.operation = "GREATER_THAN"
    cut.inputs[1].default_value = 0.5
    tree.links.new(node.outputs["Alpha"], cut.inputs[0])
    tree.links.new(cut.outputs[0], tree.nodes["Principled BSDF"].inputs["Alpha"])
    bpy.ops.mesh.primitive_plane_add(size=4)
    bpy.context.object.data.materials.append(material)
    cube((0, 0, 2), paint("roof", (0.3, 0.3, 0.3)))


@scene
def transparent():
    cube(material=paint("glass", (0.5, 0.7, 0.9), alpha=0.3))
    cube((3, 0, 0), paint("milk glass", (0.5, 0.7, 0.9), alpha=0.8))


@scene
def colour_attributes():
    one = cube()
    colours = one.data.color_attributes.new("tint", "FLOAT_COLOR", "CORNER")
    for number, corner in enumerate(colours.data):
        corner.color = (number / 24, 1 - number / 24, 0.5, 1.0)
    paint_by("tint", "tinted", one.data)


@scene
def emission():
    lamp = paint("lamp", (0, 0, 0))
    shader = lamp.node_tree.nodes["Principled BSDF"]
    shader.inputs["Emission Color"].default_value = (1.0, 0.8, 0.3, 1)
    shader.inputs["Emission Strength"].default_value = 4.0
    cube(material=lamp)


@scene
def properties():
    one = cube(material=paint("red", (0.8, 0, 0)), scale=(1, 0.3, 0.7))
    one["voxrt_collider"] = "sphere"
    other = cube((3, 0, 0), paint("green", (0, 0.8, 0)))
    other["voxrt_rule"] = "centre"
    other["voxrt_fill"] = "surface"
    other["voxrt_material"] = "red"
    left_out = cube((9, 0, 0))
    left_out["voxrt_ignore"] = True


@scene
def particles():
    bpy.ops.mesh.primitive_plane_add(size=6)
    ground = bpy.context.object
    ground.data.materials.append(paint("soil", (0.2, 0.1, 0.05)))
    grain = cube((0, 0, -5), paint("grain", (0.8, 0.7, 0.2)), name="grain")
    system = ground.modifiers.new("grains", "PARTICLE_SYSTEM").particle_system.settings
    system.type, system.count, system.render_type = "HAIR", 20, "OBJECT"
    system.instance_object, system.particle_size, system.hair_length = grain, 0.1, 4


@scene
def tufts():
    """Hair particles that show a collection of two objects, among each other."""
    tuft = bpy.data.collections.new("tuft")
    tuft.objects.link(monkey((0, 0, 9), paint("fur", (0.9, 0.2, 0.1))))
    tuft.objects.link(cube((0, 2, 9), paint("thorn", (0.1, 0.2, 0.9)), scale=(0.4, 0.4, 0.8)))
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12)
    ball = bpy.context.object
    ball.scale = (1, -2, 1.5)
    ball.data.materials.append(paint("skin", (0.5, 0.5, 0.5)))
    system = ball.modifiers.new("tufts", "PARTICLE_SYSTEM").particle_system.settings
    system.type, system.count, system.render_type = "HAIR", 60, "COLLECTION"
    system.instance_collection, system.particle_size, system.size_random = tuft, 0.15, 0.5
    system.use_advanced_hair = system.use_rotations = system.use_rotation_instance = True
    system.rotation_factor_random, system.phase_factor_random = 1, 2


@scene
def waves():
    """A painted sheet with thickness, repeated along a spiral, mirrored at a turned object, with a negative scale."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=8, y_subdivisions=8, size=2)
    sheet = bpy.context.object
    for vertex in sheet.data.vertices:
        vertex.co.z = 0.3 * math.sin(3 * vertex.co.x) * math.cos(2 * vertex.co.y)
    painted = sheet.data.color_attributes.new("Col", "BYTE_COLOR", "CORNER")
    for number, corner in enumerate(painted.data):
        corner.color = (number % 5 / 5, number % 3 / 3, 0.4, 1)
    paint_by("Col", "painted", sheet.data)
    sheet.modifiers.new("thick", "SOLIDIFY").thickness = 0.2
    repeated = sheet.modifiers.new("repeated", "ARRAY")
    repeated.count, repeated.use_relative_offset, repeated.use_object_offset = 3, False, True
    repeated.offset_object = link("step")
    repeated.offset_object.location, repeated.offset_object.rotation_euler = (1.7, 0.4, 0.6), (0.2, 0.1, 0.5)
    mirrored = sheet.modifiers.new("mirrored", "MIRROR")
    mirrored.mirror_object = link("mirror")
    mirrored.mirror_object.location, mirrored.mirror_object.rotation_euler = (-1.3, 0, 0), (0, 0, 0.3)
    sheet.scale, sheet.rotation_euler = (-1.2, 1, 0.8), (0.1, 0.7, 0.2)
