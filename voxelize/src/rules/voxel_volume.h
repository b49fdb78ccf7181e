// How much of voxels objects fill.
#pragma once

#include "../grid/brick.h"

#include <vector>

namespace voxrt::voxelize {

/// The voxels with surface that an object has in a brick.
struct VolumeBrick {
    uint32_t object;
    uint64_t code; // Morton code of the brick's corner / 8
    Slices voxels;
};

/// Which part of voxels objects fill in a tile.
struct TileVolumes {
    std::vector<VolumeBrick> bricks; // by object
    std::vector<double> values;      // 0 … 1: of the bricks' voxels, slice by slice
};

} // namespace voxrt::voxelize
