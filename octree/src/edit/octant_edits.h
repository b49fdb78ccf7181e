// Edits of an octree whose blocks are counted: each takes the word of the root and returns that of the new root. What
// does not change keeps its blocks. They throw what CountedBlocks::intern() throws; settle() then undoes them.
#pragma once

#include "../pool/block_pool.h"
#include "counted_blocks.h"
#include "shapes.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxrt::octree {

/// A voxel by its Morton code, and its material.
struct VoxelEdit {
    std::uint64_t code;
    std::uint8_t material;
};

/// Gives voxels their materials. `edits`: by code, each code once. Cost: for each voxel, the blocks above it that it
/// shares with no voxel before it.
Word set_voxels(CountedBlocks& blocks, Word root, unsigned depth, const std::vector<VoxelEdit>& edits);

/// Gives the voxels of a shape a material. Cost: the octants on its surface.
Word fill_shape(CountedBlocks& blocks, Word root, unsigned depth, const Shape& shape, std::uint8_t material);

/// Gives the solid voxels of a shape a material. Cost: the octants on its surface, and the blocks inside, each once.
Word paint_shape(CountedBlocks& blocks, Word root, unsigned depth, const Shape& shape, std::uint8_t material);

/// Puts the solid voxels of `piece`, a node of `pool` and an octree of the same depth, over what is there. Cost: the
/// pairs of blocks that lie in one place, each once.
Word overlay(CountedBlocks& blocks, Word root, const BlockPool& pool, Node piece);

/// Gives the voxels in which the octrees `before` and `after` differ what they have in `after`. Cost: the blocks in
/// which they differ, each once per block of the octree that lies there.
Word with_changes(CountedBlocks& blocks, Word root, Word before, Word after);

} // namespace voxrt::octree
