// The material that a block of an octree is seen as from afar: the mean of what is visible in it.
#pragma once

#include "../words/memory.h"

#include <array>
#include <vector>

namespace voxrt::octree {

/// Linear light of a material: red, green, blue, 1/65535.
using LinearLight = std::array<std::uint16_t, 3>;

/// A mean material per block, by number (block k is at address 1 + 8 k); 0 where the block is not to be seen as one
/// cell. `light` has the materials that may be chosen, by id; entry 0 is empty space and is never chosen.
///
/// The mean is that of the visible voxels, which share a face with an empty one or with the outside, in all places
/// where the block stands. Its material is the nearest in linear light by the sum of squared differences; of equals,
/// the one with the lowest id. A block has 0 where nothing of it is visible, or where its coverage along one of the
/// axes is less than 11/16: the part of its square that is not seen through, 0 of empty space, 1 of another leaf, of a
/// block the mean of its four columns, each of which lets through what both octants do.
///
/// Cost: that of covered_voxels() (hidden.h), and linear in the pairs of blocks of the two memories that lie in one
/// place. Blocks that are not reached from word 0 have 0. Throws std::invalid_argument where the words are no octree.
std::vector<std::uint8_t> mean_materials(const Memory& memory, const std::vector<LinearLight>& light);

} // namespace voxrt::octree
