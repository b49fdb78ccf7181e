// Queries of a memory: voxels, boxes, counts, bounds.
//
// All throw std::invalid_argument where the words are no octree. All counts are exact. Time and memory grow with the
// blocks of the memory, not with the world that sharing makes of them, unless the answer itself is large.
#pragma once

#include "../words/memory.h"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace voxrt::octree {

/// Voxels from `low` up to and without `high`.
struct Box {
    std::array<std::int64_t, 3> low;
    std::array<std::int64_t, 3> high;
};

/// The corner of octant `octant` of the octant at `corner`, whose children have the side `half`.
constexpr std::array<std::int64_t, 3> child_corner(const std::array<std::int64_t, 3>& corner, unsigned octant,
                                                   std::int64_t half) {
    return {corner[0] + (octant & 1) * half, corner[1] + (octant >> 1 & 1) * half, corner[2] + (octant >> 2) * half};
}

/// The materials of `count` voxels. `points`: 3 * count coordinates (x, y, z). `materials`: room for `count`. A voxel
/// outside the world is empty.
void materials_at(const Memory& memory, const std::int64_t* points, std::size_t count, std::uint8_t* materials);

/// 256 * (depth + 1) counts: element 256 * level + m counts the leaves of side 2**level and material m.
std::vector<std::uint64_t> leaf_counts(const Memory& memory);

/// Element m counts the voxels of material m inside `box`; what lies outside the world is not counted.
std::array<std::uint64_t, 256> count_in_box(const Memory& memory, const Box& box);

/// The smallest box that holds every solid voxel; none where there is none.
std::optional<Box> solid_bounds(const Memory& memory);

/// Writes the materials of `box`, z fastest, then y, then x; outside the world is empty. `materials` has room for every
/// voxel of the box. Cost: the box.
void fill_region(const Memory& memory, const Box& box, std::uint8_t* materials);

} // namespace voxrt::octree
