// Where two memories of one depth differ: connected regions.
#pragma once

#include "query.h"

#include <vector>

namespace voxrt::octree {

/// Voxels that differ and are connected by faces, edges or corners: the smallest box that holds them, and their counts
/// as in Difference.
struct Region {
    Box bounds;
    std::uint64_t appeared = 0;
    std::uint64_t vanished = 0;
    std::uint64_t recoloured = 0;

    std::uint64_t voxels() const { return appeared + vanished + recoloured; }
};

/// The largest difference that is split into regions, in octants that differ throughout.
constexpr std::size_t kRegionOctants = std::size_t{1} << 21;

/// All regions, those with most voxels first, then by lowest voxel. A difference of more than kRegionOctants octants is
/// one region. Cost: n log n in the octants that differ. Throws std::invalid_argument as diff() does.
std::vector<Region> differing_regions(const Memory& first, const Memory& second);

} // namespace voxrt::octree
