// A memory made coarser, or only canonical: equal blocks shared, and nothing finer than a given side.
#pragma once

#include "../pool/block_pool.h"
#include "../words/memory.h"

namespace voxrt::octree {

/// The root, in `pool`, of `memory` with every octant of side 2**level that is not uniform made one: empty where all of
/// it is empty, else solid, of the material that most of its solid voxels have (the lowest id where several do). Level
/// 0 changes no voxel and shares equal blocks. Linear in words times levels. Throws std::invalid_argument where the
/// words are no octree.
Node coarsen(const Memory& memory, unsigned level, BlockPool& pool);

/// The words of that memory, breadth-first.
Words coarsened(const Memory& memory, unsigned level);

} // namespace voxrt::octree
