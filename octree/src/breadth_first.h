// A pool of blocks to memory words.
#pragma once

#include <vector>

#include "block_pool.h"

namespace voxrt::octree {

/// The memory of the octree below `root`: blocks breadth-first by first visit at 1 + 8k, word 0 the root. Depends on
/// the tree alone and not on the order in which the pool met its blocks.
std::vector<Word> breadth_first_words(const BlockPool& pool, Node root);

} // namespace voxrt::octree
