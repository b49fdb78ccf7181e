// Nodes of a pool to memory words.
#pragma once

#include "../words/memory.h"
#include "block_pool.h"

#include <vector>

namespace voxrt::octree {

/// The memory of the octree below `root`: word 0 is the root; blocks stand at 1 + 8k in breadth-first order of first
/// visit. Depends on the tree alone, not on the order in which the pool got its blocks. Linear in the blocks.
///
/// `Pool`: BlockPool or SharedBlockPool. `threads` write the words: 0 takes as many as the machine has. Throws
/// std::length_error where 31-bit addresses cannot reach all blocks.
template <typename Pool> Words breadth_first_words(const Pool& pool, Node root, int threads = 1);

} // namespace voxrt::octree
