// How much of the visible surface two memories share.
#pragma once

#include "../words/memory.h"

namespace voxrt::octree {

/// A voxel is on the surface where it is solid and one of its six neighbours is empty or outside the world.
struct SurfaceChange {
    std::uint64_t surface; // voxels on the surface of the first
    std::uint64_t changed; // voxels of these that are not on the surface of the second, or have another material there
};

/// Compares the surface of `first` with that of `second`, voxel by voxel; both have one depth. Cost grows with the
/// surface of the first. Throws std::invalid_argument where the depths differ or words are no octree.
SurfaceChange surface_change(const Memory& first, const Memory& second);

} // namespace voxrt::octree
