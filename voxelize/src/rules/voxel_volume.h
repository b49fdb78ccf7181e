// How much of a voxel an object fills.
#pragma once

#include <cstdint>

namespace voxrt::voxelize {

/// Which part of a voxel an object fills.
struct VoxelVolume {
    std::uint32_t object;
    std::uint64_t code; // Morton code of the voxel
    double volume;      // 0 … 1
};

} // namespace voxrt::voxelize
