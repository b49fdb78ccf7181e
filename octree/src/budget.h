// A memory made smaller by giving up detail where that is seen least.
#pragma once

#include <vector>

#include "appearance.h"
#include "memory.h"

namespace voxrt::octree {

/// Memories of at most `words` words in which bricks of 8x8x8 cells of side 2**finest stand for others, chosen in
/// several ways; none where not even uniform bricks would fit. No voxel that is solid in `base` is empty in them.
/// Nothing in `base` may be finer than 2**finest; `hidden` are its hidden voxels (hidden.h). The GIL must not be held.
std::vector<std::vector<Word>> fit_bricks(const Memory& base, const Memory& hidden, unsigned finest,
                                          const SightCosts& costs, std::size_t words);

} // namespace voxrt::octree
