#include "brick.h"

#include "../pool/shared_block_pool.h"

#include <cstring>

namespace voxrt::octree {
namespace {

constexpr Node kUnknown = 0x7FFFFFFFu; // behind the last block that a pool can hold
constexpr Word kCells = 256;           // kind of a remembered pattern of 8 materials; kinds below are masks of one

} // namespace

template <typename Pool> Node BrickBuilderFor<Pool>::from_mask8(std::uint8_t mask, std::uint8_t material) {
    std::unique_ptr<NodesByMask>& nodes = nodes_by_mask_[material];
    if (!nodes) {
        nodes = std::make_unique<NodesByMask>();
        nodes->fill(kUnknown);
    }
    Node& node = (*nodes)[mask];
    if (node == kUnknown) {
        Block children;
        for (unsigned octant = 0; octant < 8; ++octant)
            children[octant] = (mask >> octant) & 1 ? leaf(material) : kEmpty;
        node = pool_.intern(children);
    }
    return node;
}

template <typename Pool> Node BrickBuilderFor<Pool>::from_mask64(std::uint64_t mask, std::uint8_t material) {
    if (mask == 0)
        return kEmpty;
    if (mask == ~std::uint64_t{0})
        return leaf(material);
    return memo_.get(mask, material, [&] {
        Block children;
        for (unsigned octant = 0; octant < 8; ++octant)
            children[octant] = from_mask8(static_cast<std::uint8_t>(mask >> (8 * octant)), material);
        return pool_.intern(children);
    });
}

template <typename Pool>
Block BrickBuilderFor<Pool>::children_from_mask(const std::uint64_t mask[8], std::uint8_t material) {
    Block children;
    for (unsigned octant = 0; octant < 8; ++octant)
        children[octant] = from_mask64(mask[octant], material);
    return children;
}

template <typename Pool> Node BrickBuilderFor<Pool>::from_cells8(const std::uint8_t cells[8]) {
    std::uint64_t eight;
    std::memcpy(&eight, cells, 8);
    if (eight == cells[0] * 0x0101010101010101u)
        return leaf(cells[0]);
    return memo_.get(eight, kCells, [&] {
        Block children;
        for (unsigned octant = 0; octant < 8; ++octant)
            children[octant] = leaf(cells[octant]);
        return pool_.intern(children);
    });
}

template <typename Pool> Node BrickBuilderFor<Pool>::from_cells64(const std::uint8_t cells[64]) {
    Block children;
    for (unsigned octant = 0; octant < 8; ++octant)
        children[octant] = from_cells8(cells + 8 * octant);
    return pool_.intern(children);
}

template <typename Pool> Block BrickBuilderFor<Pool>::children_from_cells(const std::uint8_t cells[512]) {
    Block children;
    for (unsigned octant = 0; octant < 8; ++octant)
        children[octant] = from_cells64(cells + 64 * octant);
    return children;
}

template class BrickBuilderFor<BlockPool>;
template class BrickBuilderFor<SharedBlockPool::Writer>;

} // namespace voxrt::octree
