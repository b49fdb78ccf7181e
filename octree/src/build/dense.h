// A dense array of materials to memory words.
#pragma once

#include "../words/memory.h"

#include <cstddef>
#include <vector>

namespace voxrt::octree {

/// `cells[(x * size_y + y) * size_z + z]` is the material of voxel (x, y, z); the world has 2**depth voxels per side,
/// at least as many as each size, and is empty beyond the array. Cost: one read of the array. Throws std::length_error
/// as build() does.
Words build_dense(const std::uint8_t* cells, std::size_t size_x, std::size_t size_y, std::size_t size_z,
                  unsigned depth);

} // namespace voxrt::octree
