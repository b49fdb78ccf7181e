"""USD stages that ask for a layer by every way there is."""

from __future__ import annotations

FACES = "int[] faceVertexCounts = [3, 3]\n int[] faceVertexIndices = [0, 1, 2, 0, 2, 1]\n"
POINTS = "point3f[] points = [(0, 0, 0), (7, 0, 0), (0, 7, 0)]"
SECRET = f"""#usda 1.0
(
 startTimeCode = 0
 endTimeCode = 1
)
def Mesh "m" {{
 {FACES} {POINTS}
 point3f[] points.timeSamples = {{ 0: [(0, 0, 0), (7, 0, 0), (0, 7, 0)] }}
}}
"""
OWN = f'def Mesh "own" {{\n {FACES} {POINTS}\n}}\n'

TIMES = 'double2[] active = [(0, 0)]\n double2[] times = [(0, 0), (1, 1)]\n string primPath = "/m"\n'


def clips(text: str) -> str:
    """A stage whose points come from value clips."""
    body = f"clips = {{ dictionary default = {{\n {TIMES} {text} }} }}"
    return f'#usda 1.0\ndef Mesh "m" ({body}) {{\n {FACES} point3f[] points\n}}\n{OWN}'


def arcs(name: str) -> dict[str, str]:
    """A stage for every way in which USD asks for a layer; each shows an object of its own, too."""
    stem = name.removesuffix(".1.usda")
    return {
        "reference": f'#usda 1.0\ndef "m" (references = @{name}@</m>) {{}}\n{OWN}',
        "payload": f'#usda 1.0\ndef "m" (payload = @{name}@</m>) {{}}\n{OWN}',
        "sublayer": f"#usda 1.0\n(subLayers = [@{name}@])\n{OWN}",
        "expression": f'#usda 1.0\n(expressionVariables = {{ string X = "{name}" }})\n'
        f'def "m" (references = @`"${{X}}"`@</m>) {{}}\n{OWN}',
        "variant": '#usda 1.0\ndef "m" (variants = { string v = "no" }\n prepend variantSets = "v") {\n'
        f'variantSet "v" = {{\n "yes" (references = @{name}@</m>) {{}}\n "no" {{}}\n }}\n}}\n{OWN}',
        "clips": clips(f"asset[] assetPaths = [@{name}@]\n"),
        "clips and manifest": clips(f"asset[] assetPaths = [@{name}@]\n asset manifestAssetPath = @{name}@\n"),
        "manifest": clips(f"asset[] assetPaths = [@./none.usda@]\n asset manifestAssetPath = @{name}@\n"),
        "template": clips(
            f'string templateAssetPath = "{stem}.#.usda"\n double templateStartTime = 1\n'
            " double templateEndTime = 1\n double templateStride = 1\n"
        ),
    }
