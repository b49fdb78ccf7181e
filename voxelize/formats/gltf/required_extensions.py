"""Extensions that a glTF file requires or uses, and that are not supported."""

from __future__ import annotations

from typing import TYPE_CHECKING

from voxrt.voxelize.formats.gltf.extensions import REPLACEMENTS, SUPPORTED, WITHOUT_EFFECT

if TYPE_CHECKING:
    from voxrt.voxelize.formats.gltf.document import Document


def check_required_extensions(document: Document) -> None:
    """Refuse a file that requires an unsupported extension; count unsupported ones that it only uses."""
    gltf = document.gltf
    known = SUPPORTED | WITHOUT_EFFECT
    for at, name in enumerate(gltf.extensions_required):
        if name not in known:
            fix = REPLACEMENTS.get(name, "export the file without it")
            raise document.error(f"extensionsRequired[{at}]", f"the extension {name[:60]} is not supported", fix)
    for name in dict.fromkeys(gltf.extensions_used):
        if name not in known:
            document.log.add("unknown-extension", f"the extension {name[:60]} was ignored")
