"""Rom to files and back."""

from voxrt.export.manifest import Manifest, Source, read_manifest, write_manifest
from voxrt.export.mem import MemFile, read_mem, write_mem
from voxrt.export.palette import default_materials
from voxrt.export.rom_files import RomFiles, read_rom, write_rom

__all__ = [
    "Manifest",
    "MemFile",
    "RomFiles",
    "Source",
    "default_materials",
    "read_manifest",
    "read_mem",
    "read_rom",
    "write_manifest",
    "write_mem",
    "write_rom",
]
