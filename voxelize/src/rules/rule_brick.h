// What tiles tell of bricks where a rule may leave voxels empty.
#pragma once

#include "../grid/brick.h"

namespace voxrt::voxelize {

/// A brick that surfaces pass, or that is solid in part.
struct RuleBrick {
    uint64_t code; // Morton code of the brick's corner / 8
    Slices touched, filled, surface;
    bool is_thick = false; // no voxel of it belongs to a thin part

    Slices removed() const { return without(touched, filled); }
};

/// The voxels of a brick with surface of several materials.
struct MixedSurface {
    uint64_t code;
    Slices voxels;
};

/// The voxels with surface that one object claimed in a brick.
struct OwnedSurface {
    uint64_t code;
    uint32_t object;
    Slices voxels;
};

} // namespace voxrt::voxelize
