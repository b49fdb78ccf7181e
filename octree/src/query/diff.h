// What differs between two memories of one depth.
#pragma once

#include "query.h"

namespace voxrt::octree {

/// Counts of voxels, and the smallest box that holds them all.
struct Difference {
    std::uint64_t appeared = 0;   // empty in the first, solid in the second
    std::uint64_t vanished = 0;   // solid in the first, empty in the second
    std::uint64_t recoloured = 0; // solid in both, of different materials
    std::optional<Box> bounds;    // none where nothing differs
};

/// Compares the voxels, not the words. Pairs of blocks met before are looked up in a cache of bounded size, so the cost
/// grows with the different pairs of blocks. Throws std::invalid_argument where the depths differ or words are no
/// octree.
Difference diff(const Memory& first, const Memory& second);

} // namespace voxrt::octree
