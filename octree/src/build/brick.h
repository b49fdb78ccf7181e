// A brick of 8x8x8 voxels to a node, by bit operations.
#pragma once

#include "../pool/node_memo.h"

#include <memory>

namespace voxrt::octree {

/// Turns bricks into nodes of a pool. Looks up the 2x2x2 and 4x4x4 patterns that it met before, since those of a smooth
/// surface repeat. Cost: for each 4x4x4 part one probe of a table that fits the cache.
///
/// `Pool`: BlockPool or SharedBlockPool::Writer.
template <typename Pool> class BrickBuilderFor {
public:
    explicit BrickBuilderFor(Pool& pool) : pool_(pool) {}

    /// The children of a brick of one material: bit i of the 512 (Morton order) says whether voxel i is solid.
    Block children_from_mask(const std::uint64_t mask[8], std::uint8_t material);

    /// The children of a brick of 512 materials in Morton order.
    Block children_from_cells(const std::uint8_t cells[512]);

    /// The brick of these children.
    Node from_mask(const std::uint64_t mask[8], std::uint8_t material) {
        return pool_.intern(children_from_mask(mask, material));
    }
    Node from_cells(const std::uint8_t cells[512]) { return pool_.intern(children_from_cells(cells)); }

    /// 4x4x4 voxels of one material.
    Node from_mask64(std::uint64_t mask, std::uint8_t material);

    /// 2x2x2 voxels of one material.
    Node from_mask8(std::uint8_t mask, std::uint8_t material);

    /// 4x4x4 voxels in Morton order.
    Node from_cells64(const std::uint8_t cells[64]);

    /// 2x2x2 voxels in Morton order.
    Node from_cells8(const std::uint8_t cells[8]);

private:
    using NodesByMask = std::array<Node, 256>;

    Pool& pool_;
    NodeMemo memo_;
    std::array<std::unique_ptr<NodesByMask>, 256> nodes_by_mask_; // of 2x2x2 voxels, a table per material
};

using BrickBuilder = BrickBuilderFor<BlockPool>;

} // namespace voxrt::octree
