"""Animation: the transforms of a file's nodes at one time.

Source: Khronos, glTF 2.0 specification, section 3.11 and appendix C (interpolation).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from msgspec import structs

from voxrt.voxelize.formats.gltf.accessors import read_floats

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from voxrt.voxelize.formats.gltf.document import Document
    from voxrt.voxelize.formats.gltf.schema import Gltf, Node

_COMPONENTS = {"translation": 3, "rotation": 4, "scale": 3}


def posed(document: Document, time: float | None, animation: str | None = None) -> Gltf:
    """Return the file's JSON with its nodes posed by an animation at `time` seconds.

    `animation` is its name or its index, counted from 0; None for the first. Before the first key and after the last,
    the nodes have the pose of that key. Without `time`, a named animation is shown at 0 seconds; without either, the
    nodes keep their own transforms, and animations are counted.
    """
    gltf = document.gltf
    if time is None and animation is None:
        if gltf.animations:
            message = "animations were not played: the nodes keep their own transforms"
            document.log.add("animation", message, len(gltf.animations))
        return gltf
    if not gltf.animations:
        option = "a time" if animation is None else "an animation"
        raise document.error("animations", f"{option} was given, and the file has no animation", "leave it out")
    if len(gltf.animations) > 1 and animation is None:
        message = "animations after the first were not played: --animation chooses another"
        document.log.add("animation", message, len(gltf.animations) - 1)
    nodes = list(gltf.nodes)
    _play(document, _chosen(document, animation), time or 0.0, nodes)
    return structs.replace(gltf, nodes=nodes)


def _chosen(document: Document, wanted: str | None) -> int:
    names = [animation.name for animation in document.gltf.animations]
    if wanted is None:
        return 0
    if wanted in names:
        return names.index(wanted)
    if wanted.isdecimal() and int(wanted) < len(names):
        return int(wanted)
    known = ", ".join(repr(name) if name else str(index) for index, name in enumerate(names[:8]))
    raise document.error("animations", f"no animation {wanted!r} in the file", f"it has {known}")


def _play(document: Document, index: int, time: float, nodes: list[Node]) -> None:
    """Replace the transforms of `nodes` by those of animation `index`."""
    animation = document.gltf.animations[index]
    for at, channel in enumerate(animation.channels):
        place = f"animations[{index}].channels[{at}]"
        target = channel.target
        if target.node is None or target.path not in (*_COMPONENTS, "weights"):
            document.log.add("animation", f"animations of {target.path[:40]!r} were not played")
            continue
        node = document.item(nodes, target.node, f"{place}.target.node", "node")
        sampler = document.item(animation.samplers, channel.sampler, f"{place}.sampler", "sampler")
        here = f"animations[{index}].samplers[{channel.sampler}]"
        keys = read_floats(document, sampler.input, f"{here}.input", {"SCALAR"})[:, 0]
        if len(keys) > 1 and not (np.diff(keys) > 0).all():
            raise document.error(f"{here}.input", "the times do not increase")
        stored = read_floats(document, sampler.output, f"{here}.output", {"SCALAR", "VEC3", "VEC4"})
        tangents = 3 if sampler.interpolation == "CUBICSPLINE" else 1
        width, rest = divmod(stored.size, len(keys) * tangents)
        if rest or width != _COMPONENTS.get(target.path, width) or width == 0:
            raise document.error(f"{here}.output", f"{stored.size} numbers for {len(keys)} keys of {target.path}")
        values = stored.reshape(len(keys), tangents, width)
        value = tuple(_sampled(keys, values, time, sampler.interpolation, target.path == "rotation").tolist())
        if target.path == "weights":
            nodes[target.node] = structs.replace(node, weights=list(value))
        else:
            if node.matrix is not None:
                raise document.error(f"{place}.target.node", f"node {target.node} has a matrix and cannot be animated")
            nodes[target.node] = structs.replace(node, **{target.path: value})


def _sampled(
    keys: NDArray[np.float64], values: NDArray[np.float64], time: float, interpolation: str, turns: bool
) -> NDArray[np.float64]:
    """Return the value at `time`; `values` has shape (keys, 1 or 3, components), with tangents around the value."""
    middle = values.shape[1] // 2
    after = int(np.searchsorted(keys, time, side="right"))
    if after in (0, len(keys)):
        value: NDArray[np.float64] = values[max(after - 1, 0), middle]
    elif interpolation == "STEP":
        value = values[after - 1, middle]
    else:
        span = keys[after] - keys[after - 1]
        t = (time - keys[after - 1]) / span
        start, end = values[after - 1, middle], values[after, middle]
        if interpolation == "CUBICSPLINE":
            t2, t3 = t * t, t * t * t
            leaving, arriving = span * values[after - 1, 2], span * values[after, 0]
            value = (2 * t3 - 3 * t2 + 1) * start + (t3 - 2 * t2 + t) * leaving
            value = value + (3 * t2 - 2 * t3) * end + (t3 - t2) * arriving
        elif turns:
            return _turned(start, end, t)
        else:
            value = start + t * (end - start)
    return _unit(value) if turns else value


def _turned(start: NDArray[np.float64], end: NDArray[np.float64], t: float) -> NDArray[np.float64]:
    """Interpolate unit quaternions along the shorter great arc (Shoemake, 1985)."""
    cosine = float(start @ end)
    if cosine < 0:
        end, cosine = -end, -cosine
    if cosine > 1 - 1e-9:
        value = start + t * (end - start)
    else:
        angle = np.arccos(cosine)
        value = (np.sin((1 - t) * angle) * start + np.sin(t * angle) * end) / np.sin(angle)
    return _unit(value)


def _unit(quaternion: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return `quaternion` at length 1; length 0 stays, for the node to refuse."""
    length = float(np.linalg.norm(quaternion))
    return quaternion / length if length > 0 else quaternion
