// A memory made smaller by giving up detail where it is seen least.
#pragma once

#include "../words/memory.h"
#include "appearance.h"

#include <vector>

namespace voxrt::octree {

/// Memories of at most `words` words in which bricks of 8x8x8 cells of side 2**finest represent others
/// (representatives.h), selected in several ways; none where not even uniform bricks would fit, or the world has no
/// such brick. No voxel that is solid in `base` is empty in them.
///
/// Nothing in `base` may be finer than 2**finest. `hidden` are its hidden voxels (hidden.h). Takes all threads of the
/// machine; the result does not depend on their number. Cost: seconds for tens of thousands of different bricks.
std::vector<Words> fit_bricks(const Memory& base, const Memory& hidden, unsigned finest, const AppearanceCosts& costs,
                              std::size_t words);

} // namespace voxrt::octree
