"""Rom to files and back."""

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
from voxrt.export.rom_files import WORD_SUFFIXES, RomFiles, read_rom, write_rom
from voxrt.export.vox import read_vox, write_vox
from voxrt.export.word_file import WordFile

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
