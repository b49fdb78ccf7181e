"""The cameras of a file's visible nodes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from voxrt.voxelize.formats.camera_viewpoint import camera_viewpoint

if TYPE_CHECKING:
    from voxrt.voxelize.formats.gltf.document import Document
    from voxrt.voxelize.formats.gltf.nodes import Hierarchy
    from voxrt.voxelize.scene import Viewpoint


def read_cameras(document: Document, hierarchy: Hierarchy) -> tuple[Viewpoint, ...]:
    """Return the perspective cameras of visible nodes, in authored order; others are counted in the document's log.

    A camera has its node's name, else its own, else ``cameras[N]``.
    """
    found = []
    for index in hierarchy.shown:
        node = document.gltf.nodes[index]
        if node.camera is None:
            continue
        camera = document.item(document.gltf.cameras, node.camera, f"nodes[{index}].camera", "camera")
        if camera.perspective is None:
            document.log.add("camera", "cameras without perspective were left out")
            continue
        name = node.name or camera.name or f"cameras[{node.camera}]"
        angle = math.degrees(camera.perspective.yfov)
        viewpoint = camera_viewpoint(name, hierarchy.transforms[index], angle)
        if viewpoint is None:
            document.log.add("camera", "cameras whose transform or field of view makes no picture were left out")
        else:
            found.append(viewpoint)
    return tuple(found)
