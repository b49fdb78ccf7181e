// A brick of 8x8x8 voxels to a node, by bit operations.
#pragma once

#include <cstring>
#include <vector>

#include "block_pool.h"

namespace voxrt::octree {

/// Turns bricks into nodes of a pool. Remembers the 4x4x4 masks that it met (one material each), which is where nearly
/// all the work of a smooth surface repeats.
class BrickBuilder {
public:
    explicit BrickBuilder(BlockPool& pool) : pool_(pool), memo_(1u << 14) {}

    /// A brick of one material: bit i of the 512 (Morton order) says whether voxel i is solid.
    Node from_mask(const std::uint64_t mask[8], std::uint8_t material);

    /// A brick of 512 materials in Morton order.
    Node from_cells(const std::uint8_t cells[512]);

    /// 4x4x4 voxels of one material.
    Node from_mask64(std::uint64_t mask, std::uint8_t material);

    /// 2x2x2 voxels of one material.
    Node from_mask8(std::uint8_t mask, std::uint8_t material);

    /// 4x4x4 voxels in Morton order.
    Node from_cells64(const std::uint8_t cells[64]);

    /// 2x2x2 voxels in Morton order.
    Node from_cells8(const std::uint8_t cells[8]);

private:
    struct Remembered {
        std::uint64_t mask = 0; // 0 marks a free slot: an empty mask is a leaf and never looked up
        Word material = 0;
        Node node = 0;
    };

    void grow();
    static std::size_t slot_of(std::uint64_t mask, Word material) {
        const std::uint64_t mixed = (mask ^ (std::uint64_t{material} << 56)) * 0x9E3779B97F4A7C15u;
        return static_cast<std::size_t>((mixed ^ (mixed >> 32)) * 0xD6E8FEB86659FD93u >> 32);
    }

    BlockPool& pool_;
    std::vector<Remembered> memo_;
    std::size_t remembered_ = 0;
};

} // namespace voxrt::octree
