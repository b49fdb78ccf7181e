#include "brick.h"

namespace voxrt::octree {

Node BrickBuilder::from_mask8(std::uint8_t mask, std::uint8_t material) {
    const Word solid = leaf(material);
    Block children;
    for (unsigned octant = 0; octant < 8; ++octant)
        children[octant] = (mask >> octant) & 1 ? solid : kEmpty;
    return pool_.intern(children);
}

Node BrickBuilder::from_mask64(std::uint64_t mask, std::uint8_t material) {
    if (mask == 0)
        return kEmpty;
    if (mask == ~std::uint64_t{0})
        return leaf(material);
    std::size_t i = slot_of(mask, material) & (memo_.size() - 1);
    for (; memo_[i].mask != 0; i = (i + 1) & (memo_.size() - 1))
        if (memo_[i].mask == mask && memo_[i].material == material)
            return memo_[i].node;
    Block children;
    for (unsigned octant = 0; octant < 8; ++octant)
        children[octant] = from_mask8(static_cast<std::uint8_t>(mask >> (8 * octant)), material);
    const Node node = pool_.intern(children);
    memo_[i] = {mask, material, node};
    if (2 * ++remembered_ > memo_.size())
        grow();
    return node;
}

Node BrickBuilder::from_mask(const std::uint64_t mask[8], std::uint8_t material) {
    Block children;
    for (unsigned octant = 0; octant < 8; ++octant)
        children[octant] = from_mask64(mask[octant], material);
    return pool_.intern(children);
}

Node BrickBuilder::from_cells8(const std::uint8_t cells[8]) {
    std::uint64_t eight;
    std::memcpy(&eight, cells, 8);
    if (eight == (eight & 0xFF) * 0x0101010101010101u)
        return leaf(cells[0]);
    Block children;
    for (unsigned octant = 0; octant < 8; ++octant)
        children[octant] = leaf(cells[octant]);
    return pool_.intern(children);
}

Node BrickBuilder::from_cells64(const std::uint8_t cells[64]) {
    Block children;
    for (unsigned octant = 0; octant < 8; ++octant)
        children[octant] = from_cells8(cells + 8 * octant);
    return pool_.intern(children);
}

Node BrickBuilder::from_cells(const std::uint8_t cells[512]) {
    Block children;
    for (unsigned octant = 0; octant < 8; ++octant)
        children[octant] = from_cells64(cells + 64 * octant);
    return pool_.intern(children);
}

void BrickBuilder::grow() {
    std::vector<Remembered> old(2 * memo_.size());
    old.swap(memo_);
    for (const Remembered& entry : old) {
        if (entry.mask == 0)
            continue;
        std::size_t i = slot_of(entry.mask, entry.material) & (memo_.size() - 1);
        while (memo_[i].mask != 0)
            i = (i + 1) & (memo_.size() - 1);
        memo_[i] = entry;
    }
}

} // namespace voxrt::octree
