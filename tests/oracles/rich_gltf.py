"""A small glTF file that uses nearly everything the reader knows, to be damaged by tests."""

import io

import numpy as np
from oracles.gltf_writer import GltfWriter
from PIL import Image


def rich():
    """Return the file, not yet saved."""
    writer = GltfWriter()
    uv = writer.accessor([[0, 0], [1, 0], [0, 1], [1, 1]], "u1", stride=4)
    colours = writer.accessor([[255, 0, 0], [0, 255, 0], [0, 0, 255], [9, 9, 9]], "u1", normalized=True, stride=4)
    joints = writer.accessor([[0, 1, 0, 0]] * 4, "u1")
    weights = writer.accessor([[0.5, 0.5, 0, 0]] * 4)
    attributes = {"TEXCOORD_0": uv, "COLOR_0": colours, "JOINTS_0": joints, "WEIGHTS_0": weights}
    square = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]
    mesh = writer.mesh(square, [0, 1, 2, 3], mode=5, material=0, index_dtype="u1", **attributes)
    primitive = writer.json["meshes"][mesh]["primitives"][0]
    primitive["targets"] = [{"POSITION": writer.accessor(4, sparse=([1, 3], [[1, 0, 0], [0, 1, 0]], "u2"))}]
    primitive["extensions"] = {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]}]}}
    writer.json["meshes"][mesh]["weights"] = [0.5]
    png = io.BytesIO()
    Image.fromarray(np.array([[[255, 0, 0, 255], [0, 255, 0, 9]]], np.uint8)).save(png, "PNG")
    writer.add("images", {"bufferView": writer.view(png.getvalue()), "mimeType": "image/png"})
    writer.add("samplers", {"wrapS": 33648, "wrapT": 33071, "magFilter": 9729})
    writer.add("textures", {"source": 0, "sampler": 0})
    transform = {"offset": [0.5, 0.5], "rotation": 1.0, "scale": [2, 2]}
    base = {"index": 0, "extensions": {"KHR_texture_transform": transform}}
    writer.add(
        "materials", {"pbrMetallicRoughness": {"baseColorTexture": base}, "alphaMode": "MASK", "alphaCutoff": 0.1}
    )
    glossy = {"diffuseFactor": [1, 0, 0, 1], "diffuseTexture": {"index": 0}}
    writer.add("materials", {"name": "b", "extensions": {"KHR_materials_pbrSpecularGlossiness": glossy}})
    writer.json["extensions"] = {
        "KHR_materials_variants": {"variants": [{"name": "v"}]},
        "KHR_implicit_shapes": {"shapes": [{"type": "box", "box": {"size": [1, 2, 3]}}]},
    }
    physics = {"KHR_physics_rigid_bodies": {"collider": {"geometry": {"shape": 0}}}}
    instances = {
        "TRANSLATION": writer.accessor([[0, 0, 0], [5, 0, 0]]),
        "SCALE": writer.accessor([[1, 1, 1], [2, 2, 2]]),
    }
    matrices = writer.accessor([np.eye(4)] * 2)
    writer.add("skins", {"joints": [1, 2], "inverseBindMatrices": matrices})
    writer.show(name="skinned", mesh=mesh, skin=0, extras={"voxrt_material": "b", "voxrt_collider": "hull"})
    writer.show(rotation=[0, 0, 0, 1], translation=[1, 2, 3], scale=[1, 1, -1], children=[2])
    writer.add("nodes", {"matrix": np.eye(4).ravel().tolist(), "extensions": physics})
    writer.show(mesh=mesh, extensions={"EXT_mesh_gpu_instancing": {"attributes": instances}} | physics)
    sampler = {"input": writer.accessor([0.0, 1.0]), "output": writer.accessor([[0, 0, 0], [1, 1, 1]])}
    channel = {"sampler": 0, "target": {"node": 1, "path": "translation"}}
    writer.add("animations", {"samplers": [sampler], "channels": [channel]})
    writer.json["buffers"] = [{"byteLength": len(writer.data)}]
    return writer
