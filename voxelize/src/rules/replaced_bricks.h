// Other bricks in the place of some, in sparse voxels.
#pragma once

#include "../grid/sparse_voxels.h"

#include <array>
#include <vector>

namespace voxrt::voxelize {

struct ReplacedBrick {
    uint64_t code;                // Morton code of its corner / 8
    std::array<uint64_t, 8> mask; // solid voxels, Morton order
    uint8_t material;             // of all of them, or 0
    uint32_t row;                 // of the cells, where there are several materials
};

struct ReplacedBricks {
    LargeVector<ReplacedBrick> bricks; // in ascending order of their codes
    std::vector<std::array<uint8_t, 512>> cells;
};

/// Replaces bricks. Octants that hold some are divided. Bricks without voxels go.
void replace_bricks(SparseVoxels& voxels, const ReplacedBricks& replaced);

} // namespace voxrt::voxelize
