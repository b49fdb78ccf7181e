// Questions about a memory. All throw std::invalid_argument where the words are no octree; all count exactly; none
// takes more time or memory for a memory whose sharing stands for a huge world, unless the answer itself is huge.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "memory.h"

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

/// The material of each of `count` voxels, (x, y, z) each; outside the world is empty.
void materials_at(const Memory& memory, const std::int64_t* points, std::size_t count, std::uint8_t* materials);

/// Leaves of side 2**level and material m in element 256 * level + m; 256 * (depth + 1) elements.
std::vector<std::uint64_t> leaf_counts(const Memory& memory);

/// Voxels of material m inside `box`, in element m; what lies outside the world is not counted.
std::array<std::uint64_t, 256> count_in_box(const Memory& memory, const Box& box);

/// The smallest box that holds every solid voxel; none where there is none.
std::optional<Box> solid_bounds(const Memory& memory);

/// Materials of `box`, z fastest, then y, then x; outside the world is empty. `materials` has room for the whole box.
void fill_region(const Memory& memory, const Box& box, std::uint8_t* materials);

} // namespace voxrt::octree
