// Voxels to the words of an octree memory.
//
// Equal blocks are stored once, and blocks stand in breadth-first order of first visit. So equal voxels give equal
// words, on every machine and for every number of threads.
#pragma once

#include "../words/memory.h"

#include <voxrt/voxelize/grid/sparse_voxels.h>

#include <cstddef>
#include <vector>

namespace voxrt::octree {

/// The memory of sparse bricks and octants, of depth `voxels.depth` (1 … 16). `threads`: 0 takes as many as the machine
/// has.
///
/// Cost: bricks and octants, never volume. Memory: the blocks that differ, once.
/// Throws std::invalid_argument, naming the brick or octant, where the arrays break their contract (sparse_voxels.h);
/// std::length_error where the octree has more blocks than 31-bit addresses can reach.
Words build(const voxelize::VoxelsView& voxels, int threads);

/// The memory of a world of side 2**depth whose solid voxels are given one by one: `count` Morton codes, strictly
/// ascending, and a material each. Linear in `count`. Throws as above.
Words build_points(const std::uint64_t* codes, const std::uint8_t* materials, std::size_t count, unsigned depth);

} // namespace voxrt::octree
