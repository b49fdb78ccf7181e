// The material that a block of an octree is seen as from afar: the mean of what is visible in it.
#pragma once

#include "memory.h"

#include <array>
#include <vector>

namespace voxrt::octree {

/// Linear light of a material: red, green, blue, 1/65535.
using LinearLight = std::array<std::uint16_t, 3>;

/// A mean material per block, by number (block k is at address 1 + 8 k); 0 where the block is not to be seen as one
/// cell. `light` has the materials that may be chosen, by id; entry 0 is empty space and is never chosen.
///
/// The coverage of an octant along an axis is the part of its square that is not seen through, in 1/65536: 0 of empty
/// space, 1 of another leaf; of a block the mean of its four columns, each of which lets through what both octants do. An
/// octant counts as much as is seen of it along the axes, from both sides, past the octant beside it. The mean is that of
/// linear light, and the material is the nearest by the sum of squared differences; of equals, the one with the lowest
/// id. A block whose mean coverage is less than half has 0.
///
/// Every block is looked at once. Blocks that no path reaches may hold anything; they give any material.
std::vector<std::uint8_t> mean_materials(const Memory& memory, const std::vector<LinearLight>& light);

} // namespace voxrt::octree
