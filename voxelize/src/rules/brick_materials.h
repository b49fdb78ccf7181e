// The materials of a brick in sparse voxels, whoever holds it: itself, or an octant.
#pragma once

#include "rule_bricks.h"

namespace voxrt::voxelize {

/// The materials of a solid brick's voxels: one, or by Morton code in the brick.
struct BrickMaterials {
    uint8_t only = 0;
    const std::array<uint8_t, 512>* cells = nullptr;
    uint8_t at(size_t place) const { return cells == nullptr ? only : (*cells)[place]; }
};

inline BrickMaterials materials_of(const SparseVoxels& voxels, uint64_t code) {
    const auto& codes = voxels.brick_codes;
    const auto brick = size_t(std::lower_bound(codes.begin(), codes.end(), code) - codes.begin());
    if (brick == codes.size() || codes[brick] != code)
        return {voxels.octant_materials[find_octant(voxels, code)]};
    if (voxels.brick_rows[brick] < 0)
        return {voxels.brick_materials[brick]};
    return {0, &voxels.cells[size_t(voxels.brick_rows[brick])]};
}

} // namespace voxrt::voxelize
