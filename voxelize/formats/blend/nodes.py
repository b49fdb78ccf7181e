"""Shader nodes: what a socket is connected to, and the product of colours that it shows.

A colour is understood where it is a constant, an image, a colour attribute, or a product of these. Whatever else a
node tree computes depends on the point, the view or a seed, and has no meaning here.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeAlias

import bpy
import numpy as np
from msgspec import Struct

if TYPE_CHECKING:
    from numpy.typing import NDArray

Socket: TypeAlias = Any  # bpy.types.NodeSocket
Groups: TypeAlias = tuple[Any, ...]  # the group nodes around a node, the innermost last

_UV = np.eye(3)


class ImageUse(Struct, frozen=True, eq=False):
    """An image as a texture node shows it."""

    image: Any  # bpy.types.Image
    extension: str = "REPEAT"
    nearest: bool = False
    uv: str = ""  # the UV map; empty for the one that is active for renders
    transform: NDArray[np.float64] | None = None  # float64, shape (3, 3), of (u, v, 1), v upwards; None for none


class Product(Struct, frozen=True, eq=False):
    """A product of a constant, an image and a colour attribute; `channel` is the one that a number is taken from."""

    factor: tuple[float, float, float] = (1.0, 1.0, 1.0)
    image: ImageUse | None = None
    attribute: str | None = None  # the name of a colour attribute; empty for the one that is active for renders
    channel: str = "colour"


def output_of(owner: Any) -> Any:
    """Return the output node of a material or a world; None where it has no nodes."""
    if owner.node_tree is None or (bpy.app.version < (5, 0, 0) and not owner.use_nodes):  # later ones always use them
        return None
    return owner.node_tree.get_output_node("ALL")


def source(socket: Socket, groups: Groups = ()) -> tuple[Any, Any, Groups] | None:
    """Return what feeds a socket: a node, its output, and the groups around it. None for the socket's own value.

    Reroutes and groups are followed.
    """
    for _ in range(_MOST_STEPS):
        if not socket.is_linked or not socket.links or socket.links[0].is_muted:
            return None
        link = socket.links[0]
        node, output = link.from_node, link.from_socket
        if node.type == "REROUTE":
            socket = node.inputs[0]
        elif node.type == "GROUP" and node.node_tree is not None:
            inner = next(
                (one for one in node.node_tree.nodes if one.type == "GROUP_OUTPUT" and one.is_active_output), None
            )
            found = inner and next((one for one in inner.inputs if one.identifier == output.identifier), None)
            if found is None:
                return node, output, groups
            socket, groups = found, (*groups, node)
        elif node.type == "GROUP_INPUT" and groups:
            *outer, group = groups
            found = next((one for one in group.inputs if one.identifier == output.identifier), None)
            if found is None:
                return node, output, groups
            socket, groups = found, tuple(outer)
            if not socket.is_linked:
                return _Value(socket), socket, groups
        else:
            return node, output, groups
    return None


_MOST_STEPS = 1000


class _Value:
    """The value of a group's own socket, in the place of a node."""

    type = "VALUE_OF_SOCKET"

    def __init__(self, socket: Socket) -> None:
        self.socket = socket


def product(socket: Socket, groups: Groups = ()) -> Product | None:  # noqa: PLR0911 - one per kind of node
    """Return the product that a colour socket shows; None where its nodes compute something else."""
    found = source(socket, groups)
    if found is None:
        return Product(_rgb(socket.default_value))
    node, output, groups = found
    match node.type:
        case "VALUE_OF_SOCKET":
            return Product(_rgb(node.socket.default_value))
        case "RGB" | "VALUE":
            return Product(_rgb(output.default_value))
        case "TEX_IMAGE":
            image = _image(node, groups)
            channel = "alpha" if output.name == "Alpha" else "colour"
            return None if image is None else Product(image=image, channel=channel)
        case "VERTEX_COLOR":
            return Product(attribute=node.layer_name, channel="alpha" if output.name == "Alpha" else "colour")
        case "ATTRIBUTE" if node.attribute_type == "GEOMETRY" and output.name in ("Color", "Alpha"):
            return Product(attribute=node.attribute_name, channel="alpha" if output.name == "Alpha" else "colour")
        case "MIX" | "MIX_RGB":
            return _multiplied(node, groups)
        case "MATH" if node.operation == "MULTIPLY":
            return _times(product(node.inputs[0], groups), product(node.inputs[1], groups))
        case _:
            return None


def _multiplied(node: Any, groups: Groups) -> Product | None:
    inputs = [one for one in node.inputs if one.enabled]
    if len(inputs) != 3 or node.blend_type != "MULTIPLY" or getattr(node, "data_type", "RGBA") != "RGBA":
        return None
    if source(inputs[0], groups) is not None or abs(inputs[0].default_value - 1.0) > _EPSILON:
        return None
    return _times(product(inputs[1], groups), product(inputs[2], groups))


_EPSILON = 1e-6


def _times(one: Product | None, other: Product | None) -> Product | None:
    if one is None or other is None:
        return None
    if (one.image and other.image) or (one.attribute is not None and other.attribute is not None):
        return None
    varies = [part for part in (one, other) if part.image or part.attribute is not None]
    if len({part.channel for part in varies}) > 1:
        return None
    red, green, blue = (a * b for a, b in zip(one.factor, other.factor, strict=True))
    return Product(
        (red, green, blue),
        one.image or other.image,
        other.attribute if one.attribute is None else one.attribute,
        varies[0].channel if varies else "colour",
    )


def _rgb(value: Any) -> tuple[float, float, float]:
    if isinstance(value, float | int):
        return float(value), float(value), float(value)
    red, green, blue, *_ = value
    return float(red), float(green), float(blue)


def _image(node: Any, groups: Groups) -> ImageUse | None:
    if node.image is None or node.projection != "FLAT":
        return None
    placement = _coordinates(node.inputs["Vector"], groups)
    if placement is None:
        return None
    uv, transform = placement
    return ImageUse(
        node.image, node.extension, node.interpolation == "Closest", uv, None if transform is _UV else transform
    )


def _coordinates(socket: Socket, groups: Groups) -> tuple[str, NDArray[np.float64]] | None:
    """Return the UV map that a vector socket shows, and what moves it; None for other coordinates."""
    found = source(socket, groups)
    if found is None:
        return "", _UV
    node, output, groups = found
    match node.type:
        case "UVMAP":
            return node.uv_map, _UV
        case "TEX_COORD" if output.name == "UV":
            return "", _UV
        case "ATTRIBUTE" if node.attribute_type == "GEOMETRY" and output.name == "Vector":
            return node.attribute_name, _UV
        case "MAPPING" if node.vector_type in ("POINT", "TEXTURE"):
            return _moved(node, groups)
        case _:
            return None


def _moved(node: Any, groups: Groups) -> tuple[str, NDArray[np.float64]] | None:
    inner = _coordinates(node.inputs["Vector"], groups)
    parts = [node.inputs[name] for name in ("Location", "Rotation", "Scale") if name in node.inputs]
    if inner is None or len(parts) != 3 or any(source(one, groups) is not None for one in parts):
        return None
    location, rotation, scale = (np.array(one.default_value, np.float64) for one in parts)
    if np.abs(rotation[:2]).max() > _EPSILON:
        return None
    cos, sin = np.cos(rotation[2]), np.sin(rotation[2])
    moved = np.array([[cos, -sin, location[0]], [sin, cos, location[1]], [0, 0, 1]]) @ np.diag([scale[0], scale[1], 1])
    if node.vector_type == "TEXTURE":  # the inverse
        if abs(np.linalg.det(moved)) < _EPSILON:
            return None
        moved = np.linalg.inv(moved)
    return inner[0], moved @ inner[1]


def threshold(socket: Socket, groups: Groups = ()) -> tuple[Product | None, float | None]:
    """Return what an alpha socket shows, and the alpha from which on it is solid where its author rounds it.

    The product is None where its nodes compute something else. The threshold is None for an alpha that is blended.
    """
    found = source(socket, groups)
    if found is not None and found[0].type == "MATH":
        node, _, groups = found
        first, second = node.inputs[0], node.inputs[1]
        if node.operation == "ROUND":
            return product(first, groups), 0.5
        if node.operation == "GREATER_THAN" and source(second, groups) is None:
            return product(first, groups), second.default_value
        if node.operation == "SUBTRACT" and source(first, groups) is None and first.default_value == 1.0:
            inner = source(second, groups)
            if inner is not None and inner[0].type == "MATH" and inner[0].operation == "LESS_THAN":
                value, limit = inner[0].inputs[0], inner[0].inputs[1]
                if source(limit, inner[2]) is None:
                    return product(value, inner[2]), limit.default_value
    return product(socket, groups), None
