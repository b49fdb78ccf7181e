// Where two memories of one depth differ: pieces that hang together.
#pragma once

#include <vector>

#include "query.h"

namespace voxrt::octree {

/// Voxels that differ and hang together by faces, edges or corners: the box that holds them, and how many of them only
/// the second has, only the first has, both have in another material.
struct Region {
    Box bounds;
    std::uint64_t appeared = 0;
    std::uint64_t vanished = 0;
    std::uint64_t recoloured = 0;

    std::uint64_t voxels() const { return appeared + vanished + recoloured; }
};

/// The largest difference that is taken apart, in octants that differ throughout.
constexpr std::size_t kRegionOctants = std::size_t{1} << 21;

/// All regions, those with most voxels first, then by lowest voxel. A difference of more than kRegionOctants octants is
/// given as one region. Throws std::invalid_argument where the depths differ. The GIL must not be held.
std::vector<Region> differing_regions(const Memory& first, const Memory& second);

} // namespace voxrt::octree
