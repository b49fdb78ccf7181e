"""Colours of one textured model in three formats."""

import numpy as np
from oracles.gltf_writer import GltfWriter
from oracles.meshes import box_mesh
from oracles.voxels import voxel_colours
from PIL import Image

from voxrt.voxelize import assign_colours, fit_grid, load, voxelize


def twins(folder):
    """One textured box as glTF, as OBJ and as USD."""
    box = box_mesh([0, 0, 0], [1, 1, 1])
    corners = box.positions[box.triangles].reshape(-1, 3)
    uv = np.stack([corners[:, 0] * 0.5 + corners[:, 2] * 0.5, corners[:, 1]], axis=1)
    Image.fromarray(np.random.default_rng(9).integers(0, 256, (8, 8, 3), np.uint8)).save(folder / "map.png")
    writer = GltfWriter()
    writer.add("images", {"uri": "map.png"})
    writer.add("textures", {"source": 0})
    writer.add("materials", {"name": "look", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})
    places = {"TEXCOORD_0": writer.accessor(uv)}
    writer.show(mesh=writer.mesh(corners, material=0, **places))
    upward = np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1)
    (folder / "box.mtl").write_text("newmtl look\nmap_Kd map.png\n")
    lines = ["mtllib box.mtl", *(f"v {x} {y} {z}" for x, y, z in corners), *(f"vt {u} {v}" for u, v in upward)]
    lines += ["usemtl look", *(f"f {i}/{i} {i + 1}/{i + 1} {i + 2}/{i + 2}" for i in range(1, 37, 3))]
    (folder / "box.obj").write_text("\n".join(lines) + "\n")
    (folder / "box.usda").write_text(f"""#usda 1.0
(
    upAxis = "Y"
    metersPerUnit = 1
)
def Material "look" {{
    token outputs:surface.connect = </look/s.outputs:surface>
    def Shader "s" {{
        uniform token info:id = "UsdPreviewSurface"
        color3f inputs:diffuseColor.connect = </look/t.outputs:rgb>
        token outputs:surface
    }}
    def Shader "t" {{
        uniform token info:id = "UsdUVTexture"
        asset inputs:file = @map.png@
        token inputs:wrapS = "repeat"
        token inputs:wrapT = "repeat"
        float2 inputs:st.connect = </look/r.outputs:result>
        float3 outputs:rgb
    }}
    def Shader "r" {{
        uniform token info:id = "UsdPrimvarReader_float2"
        string inputs:varname = "st"
        float2 outputs:result
    }}
}}
def Mesh "m" (prepend apiSchemas = ["MaterialBindingAPI"]) {{
    point3f[] points = {[tuple(map(float, one)) for one in corners]}
    int[] faceVertexCounts = {[3] * 12}
    int[] faceVertexIndices = {list(range(36))}
    uniform token subdivisionScheme = "none"
    texCoord2f[] primvars:st = {[tuple(map(float, one)) for one in upward]} (interpolation = "vertex")
    rel material:binding = </look>
}}
""")
    return [load(path) for path in (writer.save(folder / "box.gltf"), folder / "box.obj", folder / "box.usda")]


def test_one_model_in_three_formats_has_the_same_colours(tmp_path):
    scenes = twins(tmp_path)
    grid = fit_grid(scenes[0], depth=4)
    coloured = [assign_colours(scene, grid) for scene in scenes]
    first, *others = (voxel_colours(voxelize(scene, grid).voxels, scene.materials) for scene in coloured)
    assert len(np.unique(first.reshape(-1, 3), axis=0)) > 20
    for other in others:
        np.testing.assert_array_equal(first, other)
