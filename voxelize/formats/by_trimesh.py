"""OFF, 3MF and COLLADA files, read by trimesh and by what it uses.

A file of 3MF or COLLADA says its unit and its up axis, and its colours are sRGB; trimesh hands on neither, nor the
colours of 3MF: they are read here.
"""

from __future__ import annotations

import io
import zipfile
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from voxrt.voxelize.errors import AssetError
from voxrt.voxelize.formats.external_files import ExternalFiles, asset_name, read_asset
from voxrt.voxelize.formats.image_file import INSTEAD, decode_image
from voxrt.voxelize.formats.opacity import OPAQUE_FROM
from voxrt.voxelize.from_trimesh import trimesh_scene
from voxrt.voxelize.warning_log import WarningLog

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from voxrt.voxelize.assets import UpAxis
    from voxrt.voxelize.scene import Scene

_DAMAGED = "check the file in another program, and export it again"
_UNITS = {"micron": 1e-6, "millimeter": 1e-3, "centimeter": 1e-2, "inch": 0.0254, "foot": 0.3048, "meter": 1.0}
_UP_AXES: dict[str, UpAxis] = {"X_UP": "x", "Y_UP": "y", "Z_UP": "z"}
_FREE_BYTES, _MOST_TIMES = 1 << 26, 64
"""What the parts of a 3MF file may unpack to: so many bytes, and so many times its size more."""


def load_off(path: str | Path, *, up: UpAxis | None = None, unit: float | None = None) -> Scene:
    """Read an OFF file: one object. Its colours are not read.

    `up` and `unit` are as for :func:`voxrt.voxelize.load`. AssetError where it cannot be read.
    """
    path = Path(path)
    scene = _loaded(path, read_asset(path), "off")
    return _scene(path, next(iter(scene.geometry.values()), scene), up, unit, log=WarningLog())


def load_3mf(path: str | Path, *, opaque_from: float = OPAQUE_FROM) -> Scene:
    """Read a 3MF file: an object per built item, with components and colours.

    `opaque_from`: faces of lower opacity are left out. AssetError where it cannot be read, or the extra ``cad`` is not
    installed.
    """
    path = Path(path)
    _need(path, "lxml", "networkx")
    data = read_asset(path)
    model = _model_of(path, data)
    scene = _loaded(path, data, "3mf")
    log = WarningLog()
    for name, colours in _colours_of_objects(path, model, log).items():
        if name in scene.geometry and len(scene.geometry[name].faces) == len(colours):
            scene.geometry[name].visual = import_module("trimesh.visual").ColorVisuals(
                scene.geometry[name], face_colors=colours
            )
    unit = next((element.get("unit") for element in _elements(path, model, "model", event="start")), None)
    if (unit or "millimeter") not in _UNITS:
        raise AssetError(path, f"has the unit {unit!r}", fix=f"use one of {', '.join(_UNITS)}")
    return _scene(path, scene, "z", _UNITS[unit or "millimeter"], log=log, opaque_from=opaque_from)


def load_dae(path: str | Path, *, allow_outside: bool = False, opaque_from: float = OPAQUE_FROM) -> Scene:
    """Read a COLLADA file: an object per geometry and node, with the colours and textures of its materials.

    `allow_outside`: whether textures may stand outside the file's folder. `opaque_from`: faces of lower opacity are
    left out. AssetError where it cannot be read, or
    the extra ``cad`` is not installed.
    """
    path = Path(path)
    _need(path, "lxml", "collada")
    data = read_asset(path)
    unit = 1.0
    up: UpAxis = "y"
    for element in _elements(path, data, "unit", "up_axis"):
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


_DISTRIBUTIONS = {"collada": "pycollada"}  # of modules, where the name is another


def _need(path: Path, *modules: str) -> None:
    for module in modules:
        try:
            import_module(module)
        except ImportError:
            fix = f"pip install {_DISTRIBUTIONS.get(module, module)}"
            raise AssetError(path, f"takes {module}, which is not installed", fix=fix) from None


def _metres(path: Path, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise AssetError(path, f"has a unit of {text[:24]!r} metres", fix=_DAMAGED) from None


def _loaded(path: Path, data: bytes, kind: str, **options: Any) -> Any:  # noqa: ANN401 - trimesh has no types
    import trimesh  # noqa: PLC0415 - it is slow to import

    try:
        return trimesh.load_scene(io.BytesIO(data), file_type=kind, process=False, **options)
    except MemoryError:
        raise
    except Exception as error:  # noqa: BLE001 - it raises whatever its parsers do
        raise AssetError(path, f"trimesh cannot read it ({type(error).__name__})", fix=_DAMAGED) from None


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
        raise AssetError(path, f"shows {error}, which is not in it", fix=_DAMAGED) from None
    except (TypeError, ValueError) as error:
        raise AssetError(path, str(error), fix=_DAMAGED) from None
    if not any(len(one.mesh.triangles) for one in made.objects):
        for warning in made.warnings:
            if warning.kind == "transparent":
                raise AssetError(path, f"shows nothing: {warning.message}", fix="make its colours opaque")
        raise AssetError(path, "has no triangles", fix="export it with its surface")
    return replace(made, warnings=made.warnings + log.warnings())


def _model_of(path: Path, data: bytes) -> bytes:
    """Return the part of a 3MF file that has its objects."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            allowed = _FREE_BYTES + _MOST_TIMES * len(data)
            if sum(one.file_size for one in archive.infolist()) > allowed:
                problem = f"unpacks to more than {allowed >> 20} MiB, which is too much for its size"
                raise AssetError(path, problem, fix="it is made to do harm, or must be packed anew")
            names = [name for name in archive.namelist() if "3d/3dmodel.model" in name.lower()]
            return archive.read(names[0])
    except (zipfile.BadZipFile, IndexError, OSError, NotImplementedError, RuntimeError, EOFError, ValueError) as error:
        raise AssetError(path, f"is no 3MF package ({type(error).__name__})", fix=_DAMAGED) from None


def _elements(path: Path, text: bytes, *tags: str, event: str = "end") -> Iterator[Any]:
    etree = import_module("lxml.etree")
    try:
        for _, element in etree.iterparse(
            io.BytesIO(text),
            events=(event,),
            tag=[f"{{*}}{tag}" for tag in tags],
            resolve_entities=False,
            no_network=True,
        ):
            yield element
    except etree.XMLSyntaxError as error:
        raise AssetError(path, f"its XML is broken ({' '.join(str(error.msg).split())})", fix=_DAMAGED) from None


@dataclass(frozen=True, slots=True)
class _Triangles:
    """Which colours the triangles of an object have: group and row, or None."""

    name: str
    colours: list[tuple[str, int] | None]


def _colours_of_objects(path: Path, model: bytes, log: WarningLog) -> dict[str, NDArray[np.uint8]]:
    """Return the colours of triangles, uint8, shape (T, 4), of each object that has some, by its name in trimesh."""
    unique_name = import_module("trimesh.util").unique_name
    groups: dict[str, list[tuple[int, ...] | None]] = {}
    objects: list[_Triangles] = []
    used: set[str] = set()
    counts: dict[str, int] = {}
    for element in _elements(path, model, "basematerials", "colorgroup", "object"):
        number = element.get("id", "")
        if not element.tag.endswith("object"):
            groups[number] = [_colour(one.get("displaycolor") or one.get("color") or "") for one in element]
            continue
        name = unique_name(element.get("name", number), used, counts)
        used.add(name)
        own = element.get("pid"), element.get("pindex")
        rows = [_reference(one.get("pid") or own[0], one.get("p1") or own[1]) for one in element.iter("{*}triangle")]
        if any(row is not None for row in rows):
            objects.append(_Triangles(name, rows))
    found = {one.name: [row and _at(groups.get(row[0], []), row[1]) for row in one.colours] for one in objects}
    lost = sum(row is not None for one in objects for row in one.colours) - sum(
        colour is not None for colours in found.values() for colour in colours
    )
    log.add(
        "material-colour", "triangles with a texture, or a colour that the file lacks, got the default colour", lost
    )
    return {name: np.array([one or _DEFAULT for one in colours], np.uint8) for name, colours in found.items()}


_DEFAULT = (200, 200, 200, 255)


def _reference(group: str | None, row: str | None) -> tuple[str, int] | None:
    return (group, int(row)) if group is not None and row is not None and row.isdecimal() else None


def _at(colours: list[tuple[int, ...] | None], row: int) -> tuple[int, ...] | None:
    return colours[row] if row < len(colours) else None


def _colour(text: str) -> tuple[int, ...] | None:
    """Return ``#RRGGBB`` or ``#RRGGBBAA`` as red, green, blue and opacity; None for other text."""
    digits = text.strip().lstrip("#")
    try:
        found = bytes.fromhex(digits)
    except ValueError:
        return None
    return (*found, 255)[:4] if len(found) in (3, 4) else None
