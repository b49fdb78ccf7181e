"""Rom to files and back."""

from importlib import import_module
from typing import TYPE_CHECKING

__all__ = [
    "READABLE_SUFFIXES",
    "WORD_SUFFIXES",
    "WRITABLE_SUFFIXES",
    "BakedLight",
    "Blob",
    "Manifest",
    "Provenance",
    "RomFiles",
    "RomInfo",
    "Source",
    "WordFile",
    "blob_bytes",
    "convert",
    "default_materials",
    "read_any",
    "read_blob",
    "read_coe",
    "read_listing",
    "read_manifest",
    "read_mem",
    "read_mif",
    "read_raw",
    "read_rom",
    "read_vox",
    "rom_info",
    "write_blob",
    "write_coe",
    "write_manifest",
    "write_mem",
    "write_mif",
    "write_npz",
    "write_raw",
    "write_rom",
    "write_vox",
]

# Imported when first used: a build waits for what it needs alone.
_HOMES = {
    "voxrt.export.blob": ("Blob", "blob_bytes", "read_blob", "write_blob"),
    "voxrt.export.coe": ("read_coe", "write_coe"),
    "voxrt.export.conversion": ("READABLE_SUFFIXES", "WRITABLE_SUFFIXES", "convert", "read_any"),
    "voxrt.export.info": ("RomInfo", "rom_info"),
    "voxrt.export.listing": ("read_listing",),
    "voxrt.export.manifest": ("Manifest", "read_manifest", "write_manifest"),
    "voxrt.export.mem": ("read_mem", "write_mem"),
    "voxrt.export.mif": ("read_mif", "write_mif"),
    "voxrt.export.npz": ("write_npz",),
    "voxrt.export.palette": ("default_materials",),
    "voxrt.export.provenance": ("BakedLight", "Provenance", "Source"),
    "voxrt.export.raw": ("read_raw", "write_raw"),
    "voxrt.export.rom_files": ("RomFiles", "read_rom", "write_rom"),
    "voxrt.export.vox": ("read_vox", "write_vox"),
    "voxrt.export.word_file": ("WordFile",),
    "voxrt.export.word_formats": ("WORD_SUFFIXES",),
}
_HOME = {name: home for home, names in _HOMES.items() for name in names}

if TYPE_CHECKING:  # type checkers see these names and no others
    from voxrt.export.blob import Blob, blob_bytes, read_blob, write_blob
    from voxrt.export.coe import read_coe, write_coe
    from voxrt.export.conversion import READABLE_SUFFIXES, WRITABLE_SUFFIXES, convert, read_any
    from voxrt.export.info import RomInfo, rom_info
    from voxrt.export.listing import read_listing
    from voxrt.export.manifest import Manifest, read_manifest, write_manifest
    from voxrt.export.mem import read_mem, write_mem
    from voxrt.export.mif import read_mif, write_mif
    from voxrt.export.npz import write_npz
    from voxrt.export.palette import default_materials
    from voxrt.export.provenance import BakedLight, Provenance, Source
    from voxrt.export.raw import read_raw, write_raw
    from voxrt.export.rom_files import RomFiles, read_rom, write_rom
    from voxrt.export.vox import read_vox, write_vox
    from voxrt.export.word_file import WordFile
    from voxrt.export.word_formats import WORD_SUFFIXES
else:

    def __getattr__(name: str) -> object:
        if name in _HOME:
            return getattr(import_module(_HOME[name]), name)
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
