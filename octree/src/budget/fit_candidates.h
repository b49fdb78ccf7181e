// Smaller memories of a scene, of which one is chosen for a budget.
#pragma once

#include "../words/memory.h"
#include "appearance.h"

#include <stdexcept>
#include <vector>

namespace voxrt::octree {

/// Even the coarsest world takes more words.
struct DoesNotFit : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Memories of at most `words` words: the finest plain coarser world, and finer ones with fewer different bricks
/// (budget.h). `shared`: a canonical memory with more words. Throws DoesNotFit.
std::vector<Words> fit_candidates(const Memory& shared, std::size_t words, const AppearanceCosts& costs);

} // namespace voxrt::octree
