// A memory made smaller by giving up detail where that changes least.
#pragma once

#include <vector>

#include "cluster.h"
#include "memory.h"

namespace voxrt::octree {

/// The memory of `base` after its blocks two levels above side 2**finest let others stand for them, each at a cost of
/// at most `fine_price`, and after them those three levels above, at most `coarse_price` each. No voxel that is solid
/// becomes empty. Nothing in `base` may be finer than 2**finest; `hidden` are its hidden voxels (hidden.h), whose
/// material costs nothing. The GIL must not be held.
std::vector<Word> merge_blocks(const Memory& base, const Memory& hidden, unsigned finest, const RecolourCosts& recolour,
                               std::uint64_t fine_price, std::uint64_t coarse_price);

} // namespace voxrt::octree
