// What differs between two memories of one depth.
#pragma once

#include "query.h"

namespace voxrt::octree {

/// Voxels that only the second has, only the first has, and that both have in another material; `bounds` holds them
/// all.
struct Difference {
    std::uint64_t appeared = 0;
    std::uint64_t vanished = 0;
    std::uint64_t recoloured = 0;
    std::optional<Box> bounds;
};

/// Compares the voxels, not the words. Pairs of blocks met before are looked up in a cache of bounded size. Throws
/// std::invalid_argument where the depths differ.
Difference diff(const Memory& first, const Memory& second);

} // namespace voxrt::octree
