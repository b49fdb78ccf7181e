"""OFF and COLLADA files, read by trimesh and by what it uses.

A file of COLLADA says its unit and its up axis, and its colours are sRGB; trimesh hands on neither: they are read here.
"""

from __future__ import annotations

import io
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.voxelize.errors import DAMAGED, AssetError
from voxrt.voxelize.formats.external_files import ExternalFiles, asset_name, read_asset
from voxrt.voxelize.formats.image_file import INSTEAD, decode_image
from voxrt.voxelize.formats.opacity import OPAQUE_FROM, nothing_shown
from voxrt.voxelize.formats.xml_elements import need, xml_elements
from voxrt.voxelize.from_trimesh import trimesh_scene
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from voxrt.voxelize.assets import UpAxis
    from voxrt.voxelize.scene import Scene

_UP_AXES: dict[str, UpAxis] = {"X_UP": "x", "Y_UP": "y", "Z_UP": "z"}


def load_off(path: str | Path, *, up: UpAxis | None = None, unit: float | None = None) -> Scene:
    """Read an OFF file: one object. Its colours are not read.

    `up` and `unit` are as for :func:`voxrt.voxelize.load`. AssetError where it cannot be read.
    """
    path = Path(path)
    scene = _loaded(path, read_asset(path), "off")
    return _scene(path, next(iter(scene.geometry.values()), scene), up, unit, log=WarningLog())


def load_dae(path: str | Path, *, allow_outside: bool = False, opaque_from: float = OPAQUE_FROM) -> Scene:
    """Read a COLLADA file: an object per geometry and node, with the colours and textures of its materials.

    `allow_outside`: whether textures may stand outside the file's folder. `opaque_from`: faces of lower opacity are
    left out. AssetError where it cannot be read, or the extra ``cad`` is not installed.
    """
    path = Path(path)
    need(path, "lxml", "collada")
    data = read_asset(path)
    unit = 1.0
    up: UpAxis = "y"
    for element in xml_elements(path, data, "unit", "up_axis"):
        if element.tag.endswith("unit"):
            unit = _metres(path, element.get("meter") or "1")
        else:
            up = _UP_AXES.get((element.text or "").strip(), "y")
    textures = _Textures(path, ExternalFiles.of(path, allow_outside=allow_outside), WarningLog())
    scene = _loaded(path, data, "dae", resolver=textures)
    for geometry in scene.geometry.values():
        material = getattr(geometry.visual, "material", None)
        factor = getattr(material, "baseColorFactor", None)
        if material is not None and factor is not None and material.baseColorTexture is None:
            emission = np.round(np.clip(np.nan_to_num(material.emissiveFactor), 0, 1) * 255)
            if not np.any(factor[:3]) and emission.any() and material.emissiveTexture is None:
                factor = [*emission, factor[3]]  # what reflects nothing shows what it emits
            # The factor is sRGB, and not linear as in glTF.
            geometry.visual.material = import_module("trimesh.visual.material").SimpleMaterial(
                diffuse=np.asarray(factor, np.uint8), name=material.name
            )
    return _scene(path, scene, up, unit, log=textures.log, opaque_from=opaque_from)


@dataclass(frozen=True, slots=True)
class _Textures:
    """What trimesh asks for the textures of a file: those that may not be opened, or cannot be read, are warnings."""

    path: Path
    external_files: ExternalFiles
    log: WarningLog

    def get(self, name: str) -> bytes:
        """Return the bytes of an image; KeyError where there is none."""
        files = self.external_files
        found = files.reported(files.find_exported(name), "texture", name, self.log, instead=INSTEAD)
        data = b"" if found is None else read_asset(found)
        if not data or decode_image(data, self.path, f"texture {name}", self.log) is None:
            raise KeyError(name)
        return data


def _metres(path: Path, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise AssetError(path, f"has a unit of {text[:24]!r} metres", fix=DAMAGED) from None


def _loaded(path: Path, data: bytes, kind: str, **options: Any) -> Any:  # noqa: ANN401 - trimesh has no types
    import trimesh  # noqa: PLC0415 - it is slow to import

    try:
        return trimesh.load_scene(io.BytesIO(data), file_type=kind, process=False, **options)
    except MemoryError:
        raise
    except Exception as error:  # noqa: BLE001 - it raises whatever its parsers do
        raise AssetError(path, f"trimesh cannot read it ({type(error).__name__})", fix=DAMAGED) from None


def _scene(
    path: Path,
    scene: Any,  # noqa: ANN401 - trimesh has no types
    up: UpAxis | None,
    unit: float | None,
    *,
    log: WarningLog,
    opaque_from: float = OPAQUE_FROM,
) -> Scene:
    try:
        made = trimesh_scene(scene, name=asset_name(path), up=up, unit=unit, opaque_from=opaque_from)
    except KeyError as error:
        raise AssetError(path, f"shows {error}, which is not in it", fix=DAMAGED) from None
    except (TypeError, ValueError) as error:
        raise AssetError(path, str(error), fix=DAMAGED) from None
    if not any(len(one.mesh.triangles) for one in made.objects):
        raise nothing_shown(path, made.warnings)
    return replace(made, warnings=made.warnings + log.warnings())
