"""Make a city of instanced buildings as USD, to build it as a large scene: ``python bench/city.py FOLDER [--count N]``.

Each kind of building is a file of its own, which ``city.usda`` takes as a payload; a point instancer places them on
blocks of streets. The same arguments give the same bytes.

    python bench/city.py /tmp/city --count 100000
    voxrt build /tmp/city/city.usda --depth 15 --fill surface --workers 2 -o /tmp/city/city.bin
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np

KINDS = 8
PITCH = 40.0
"""Metres from one building to the next."""

STREET = 10
"""Buildings between two streets."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--count", type=int, default=100_000, help="buildings")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    random = np.random.default_rng(0)
    for kind in range(KINDS):
        (options.folder / f"building{kind}.usda").write_text(building(kind, random))
    (options.folder / "city.usda").write_text(city(options.count, random))


def building(kind: int, random: np.random.Generator) -> str:
    """Return a building: towers of boxes, each narrower than the one below."""
    width, low, towers = 28.0, 0.0, []
    for number in range(1 + kind % 4):
        high = low + float(random.integers(6, 30))
        towers.append(box(f"tower{number}", (width, high - low, width * 0.8), low))
        width, low = width * 0.7, high
    colour = ", ".join(f"{value:.2f}" for value in random.uniform(0.4, 0.9, 3))
    return f"""#usda 1.0
(
    defaultPrim = "building"
    metersPerUnit = 1
    upAxis = "Y"
)

def Xform "building"
{{
    color3f[] primvars:displayColor = [({colour})] (
        interpolation = "constant"
    )
{"".join(towers)}}}
"""


def box(name: str, size: tuple[float, float, float], low: float) -> str:
    """Return a mesh of six quads that stands at a height."""
    x, z = size[0] / 2, size[2] / 2
    corners = [(i, j, k) for i in (-x, x) for j in (low, low + size[1]) for k in (-z, z)]
    points = ", ".join(f"({a:.3f}, {b:.3f}, {c:.3f})" for a, b, c in corners)
    return f"""
    def Mesh "{name}"
    {{
        int[] faceVertexCounts = [4, 4, 4, 4, 4, 4]
        int[] faceVertexIndices = [0, 1, 3, 2, 4, 6, 7, 5, 0, 4, 5, 1, 2, 3, 7, 6, 0, 2, 6, 4, 1, 5, 7, 3]
        point3f[] points = [{points}]
        uniform token subdivisionScheme = "none"
    }}
"""


def city(count: int, random: np.random.Generator) -> str:
    """Return the scene: a point instancer of so many buildings."""
    side = int(np.ceil(np.sqrt(count)))
    number = np.arange(count)
    place = np.stack([number % side, number // side], axis=1)
    metres = PITCH * (place + place // STREET)
    positions = ", ".join(f"({x:.0f}, 0, {z:.0f})" for x, z in metres)
    kinds = ", ".join(map(str, random.integers(0, KINDS, count)))
    names = ", ".join(f"</city/kinds/kind{kind}>" for kind in range(KINDS))
    payloads = "".join(
        f"""
        def "kind{kind}" (
            payload = @./building{kind}.usda@
        )
        {{
        }}
"""
        for kind in range(KINDS)
    )
    return f"""#usda 1.0
(
    defaultPrim = "city"
    metersPerUnit = 1
    upAxis = "Y"
)

def PointInstancer "city"
{{
    rel prototypes = [{names}]
    int[] protoIndices = [{kinds}]
    point3f[] positions = [{positions}]

    def Scope "kinds"
    {{{payloads}    }}
}}
"""


if __name__ == "__main__":
    main()
