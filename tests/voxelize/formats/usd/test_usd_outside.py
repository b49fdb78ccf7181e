"""USD stages that name layers and textures outside of their folder."""

import re

import numpy as np
import pytest
from oracles.usd_in_process import load_usd
from PIL import Image

from voxrt.voxelize import AssetError

TRIANGLE = """
    point3f[] points = [(0,0,0),(1,0,0),(1,1,0)]
    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0,1,2]
"""


def test_layers_outside_the_folder_are_not_opened(tmp_path):
    (tmp_path / "shared.usda").write_text(f'#usda 1.0\ndef Mesh "triangle" {{ {TRIANGLE} }}\n')
    inner = tmp_path / "inner"
    inner.mkdir()
    (inner / "middle.usda").write_text('#usda 1.0\ndef "triangle" (references = @../shared.usda@</triangle>) {}\n')
    path = inner / "stage.usda"
    for text, place in (
        ("(subLayers = [@./middle.usda@])", "middle.usda: "),
        ("(subLayers = [@../shared.usda@])", ""),
        (f'def "a" (payload = @{tmp_path}/shared.usda@</triangle>) {{}}', ""),
    ):
        path.write_text(f"#usda 1.0\n{text}\n")
        with pytest.raises(AssetError, match=rf"stage.usda: {place}layer '.*shared.usda' is outside .*--allow-outside"):
            load_usd(path)
        assert len(load_usd(path, allow_outside=True).objects) == 1


def test_a_file_reached_by_a_link_is_named_once(tmp_path):
    inner = tmp_path / "inner"
    inner.mkdir()
    (inner / "stage.usda").write_text("#usda 1.0\n(subLayers = [@../shared.usda@])\n")
    (tmp_path / "shared.usda").write_text("#usda 1.0\n")
    linked = tmp_path / "linked"
    linked.symlink_to(inner)
    with pytest.raises(AssetError) as caught:
        load_usd(linked / "stage.usda")
    assert caught.value.place == ""


def test_textures_outside_the_folder_are_not_opened(tmp_path):
    Image.fromarray(np.zeros((2, 2, 3), np.uint8)).save(tmp_path / "map.png")
    (tmp_path / "inner").mkdir()
    path = tmp_path / "inner" / "stage.usda"
    path.write_text(f"""#usda 1.0
def Mesh "triangle" (prepend apiSchemas = ["MaterialBindingAPI"]) {{ {TRIANGLE}
    texCoord2f[] primvars:st = [(0, 0)] (interpolation = "constant")
    rel material:binding = </m>
}}
def Material "m" {{
    token outputs:surface.connect = </m/s.outputs:surface>
    def Shader "s" {{
        uniform token info:id = "UsdPreviewSurface"
        color3f inputs:diffuseColor.connect = </m/t.outputs:rgb>
        token outputs:surface
    }}
    def Shader "t" {{
        uniform token info:id = "UsdUVTexture"
        asset inputs:file = @../map.png@
        float3 outputs:rgb
    }}
}}
""")
    counted = {one.kind: one.message for one in load_usd(path).warnings}
    assert re.search(r"texture 'map.png' is outside .*--allow-outside", counted["outside"])
    assert "outside" not in {one.kind for one in load_usd(path, allow_outside=True).warnings}
