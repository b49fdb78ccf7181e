"""Files that the validator of glTF is tested with: each is refused for what is wrong with it."""

import pytest
from assets import asset, over_assets

from voxrt.voxelize import AssetError, load


@over_assets(
    ("name", "message"),
    [
        ("buffer/wrong_bytelength.glb", r"buffers\[0\]: its byteLength is 17, and it has 16 bytes"),
        ("buffer/invalid_uri_data.gltf", r"buffers\[0\]\.uri: a data URI with an empty parameter"),
        ("buffer/invalid_uri_scheme.gltf", r"buffers\[0\]\.uri: the address ':' was not opened"),
        ("buffer/not_found.gltf", r"buffers\[0\]\.uri: no file 'not_found\.bin' in the asset's folder"),
        ("buffer/zero_bytelength.gltf", r"buffers\[0\]\.byteLength: expected .int. >= 1"),
        ("accessor/unresolved_bufferviews.gltf", r"accessors\[0\]\.bufferView: buffer view 0 does not exist"),
        ("accessor/invalid_sparse_count_and_stride.gltf", r"accessors\[0\]\.sparse: replaces 2 of 1 elements"),
        ("accessor/small_stride.gltf", r"accessors\[0\]: elements of 16 bytes in a buffer view of stride 4"),
        ("accessor/byteoffset_no_bufferview.gltf", r"accessors\[0\]: has a byteOffset and no bufferView"),
        ("glb/chunk_too_big.glb", r"the GLB says it has 13 bytes and has 48"),
        ("glb/misplaced_bin_chunk.glb", r"byte 88: the binary chunk is not the second"),
        ("glb/unaligned_chunk.glb", r"byte 12: a chunk of 27 bytes, not a multiple of 4"),
        ("json/invalid_object.gltf", r"expected .object., got .array."),
    ],
)
def test_refused_for_what_is_wrong(name, message):
    with pytest.raises(AssetError, match=message):
        load(asset(f"malformed/glTF-Validator/{name}"))
