// The size that a memory has once equal blocks are stored once, without making that memory.
#pragma once

#include "../words/memory.h"

namespace voxrt::octree {

/// Words of the memory with the same voxels in which equal blocks are stored once, and a block of eight equal leaves is
/// their leaf. Takes 12 to 20 bytes per block of `memory`. Throws std::invalid_argument where the words are no octree.
std::size_t shared_words(const Memory& memory);

} // namespace voxrt::octree
